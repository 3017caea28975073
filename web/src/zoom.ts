// Zoom and pan that any number of views share: what one shows, all show.

export interface Place { scale: number; x: number; y: number } // x, y: shift in parts of the view's width and height

export class SharedZoom {
  private place: Place = { scale: 1, x: 0, y: 0 };
  private readonly frames: HTMLElement[] = [];
  private readonly views: HTMLElement[] = [];
  private pan: { pointer: number; x: number; y: number } | null = null; // the pointer that pans, and where it was

  get zoomed(): boolean {
    return this.place.scale > 1;
  }

  // A view is moved inside of whatever frame it is in.
  addView(view: HTMLElement): void {
    this.views.push(view);
    this.show(this.place);
  }

  // A frame takes the gestures: drag to pan, control and wheel to zoom, double click to go in and, with shift, back.
  add(frame: HTMLElement): void {
    this.frames.push(frame);
    frame.addEventListener(
      "wheel",
      (event) => {
        if (!event.ctrlKey && !event.metaKey && this.place.scale === 1) return;
        event.preventDefault();
        this.zoomAt(frame, event.clientX, event.clientY, Math.exp(-event.deltaY * 0.002));
      },
      { passive: false },
    );
    frame.addEventListener("dblclick", (event) => {
      if (event.shiftKey || this.place.scale > 12) this.reset();
      else this.zoomAt(frame, event.clientX, event.clientY, 2.5);
    });
    frame.addEventListener("pointerdown", (event) => {
      if (!this.zoomed || (event.target as Element).closest(".divider")) return;
      this.pan = { pointer: event.pointerId, x: event.clientX, y: event.clientY };
      frame.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    frame.addEventListener("pointermove", (event) => {
      if (this.pan?.pointer !== event.pointerId || !frame.hasPointerCapture(event.pointerId)) return;
      const { x, y } = this.pan;
      this.pan = { pointer: event.pointerId, x: event.clientX, y: event.clientY };
      this.show({
        scale: this.place.scale,
        x: this.place.x + (event.clientX - x) / frame.clientWidth,
        y: this.place.y + (event.clientY - y) / frame.clientHeight,
      });
    });
    for (const kind of ["pointerup", "pointercancel"] as const) frame.addEventListener(kind, () => (this.pan = null));
    this.show(this.place);
  }

  reset(): void {
    this.show({ scale: 1, x: 0, y: 0 });
  }

  private zoomAt(frame: HTMLElement, clientX: number, clientY: number, factor: number): void {
    const box = frame.getBoundingClientRect();
    const u = (clientX - box.left) / box.width;
    const v = (clientY - box.top) / box.height;
    const scale = Math.min(32, Math.max(1, this.place.scale * factor));
    const grown = scale / this.place.scale;
    this.show({ scale, x: u - grown * (u - this.place.x), y: v - grown * (v - this.place.y) });
  }

  private show(place: Place): void {
    // The picture never leaves its frame.
    const least = 1 - place.scale;
    const held = (value: number): number => Math.min(0, Math.max(least, value));
    this.place = { scale: place.scale, x: held(place.x), y: held(place.y) };
    const { scale, x, y } = this.place;
    for (const view of this.views) view.style.transform = `translate(${x * 100}%, ${y * 100}%) scale(${scale})`;
    for (const frame of this.frames) frame.classList.toggle("zoomed", scale > 1);
  }
}
