import { defineConfig } from "vite";

// Puts the scripts and styles of the bundle into the page itself, so that one file is all there is.
function singleFile() {
  return {
    name: "single-file",
    enforce: "post",
    generateBundle(_, bundle) {
      const page = bundle["index.html"];
      for (const [name, file] of Object.entries(bundle)) {
        const place = name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
        if (file.type === "chunk") {
          const code = file.code.replaceAll("</script", "<\\/script");
          page.source = page.source.replace(new RegExp(`<script[^>]*src="[^"]*${place}"[^>]*></script>`), "");
          page.source = page.source.replace("</body>", () => `<script type="module">${code}</script>\n</body>`);
        } else if (name.endsWith(".css")) {
          const link = new RegExp(`<link[^>]*href="[^"]*${place}"[^>]*>`);
          page.source = page.source.replace(link, () => `<style>${file.source}</style>`);
        } else {
          continue;
        }
        delete bundle[name];
      }
      const left = Object.keys(bundle).filter((name) => name !== "index.html");
      if (left.length > 0) this.error(`the page would need files beside it: ${left.join(", ")}`);
    },
  };
}

export default defineConfig({
  plugins: [singleFile()],
  build: { target: "es2021", assetsInlineLimit: 1e8, modulePreload: false, cssCodeSplit: false, reportCompressedSize: false },
});
