// Puts the reports that the page carries on show.
import { element } from "./dom";
import type { Report, ReportSet, VerdictSection } from "./report";
import { sectionView } from "./sections";
import "./style.css";
import { rich } from "./text";
import { startTheme } from "./theme";

function readData(): ReportSet {
  const text = document.getElementById("report-data")!.textContent!;
  return JSON.parse(text) as ReportSet;
}

const verdicts = (report: Report): VerdictSection[] =>
  report.sections.filter((section): section is VerdictSection => section.kind === "verdict");

function reportView(report: Report): HTMLElement {
  const made = element("article", { id: report.name });
  if (report.group) made.append(element("div", { class: "group" }, report.group));
  made.append(element("h2", {}, element("a", { href: `#${report.name}` }, rich(report.title))));
  for (const section of report.sections) made.append(sectionView(section));
  return made;
}

function contents(reports: Report[]): HTMLElement {
  const made = element("nav", { "aria-label": "Contents" });
  let group = "";
  for (const report of reports) {
    if (report.group !== group) made.append(element("div", { class: "group" }, report.group));
    group = report.group;
    const link = element("a", { href: `#${report.name}` }, rich(report.title));
    if (verdicts(report).length > 0) link.classList.add(report.passed ? "holds" : "fails");
    made.append(link);
  }
  return made;
}

// Marks the report that is being read.
function followReading(nav: HTMLElement, main: HTMLElement): void {
  const observer = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        nav.querySelector("a.here")?.classList.remove("here");
        const link = nav.querySelector<HTMLElement>(`a[href="#${entry.target.id}"]`);
        link?.classList.add("here");
        if (link) nav.scrollTop = link.offsetTop - nav.clientHeight / 2;
      }
    },
    { rootMargin: "-15% 0px -75% 0px" },
  );
  main.querySelectorAll("article").forEach((article) => observer.observe(article));
}

function summary(set: ReportSet): HTMLElement {
  const all = set.reports.flatMap(verdicts);
  const failed = all.filter((verdict) => !verdict.passed).length;
  const made = element("p", { class: "summary" }, rich(set.subtitle));
  if (all.length === 0) return made;
  const words = failed === 0 ? `All ${all.length} verdicts hold.` : `${failed} of ${all.length} verdicts fail.`;
  made.append(" ", element("strong", { class: failed === 0 ? "holds" : "fails" }, words));
  return made;
}

function start(): void {
  const set = readData();
  document.title = set.title;
  const switcher = element("button", { type: "button", class: "theme", title: "Light or dark" }, "◐");
  startTheme(switcher);
  const head = element("header", {}, element("h1", {}, rich(set.title)), summary(set), switcher);
  const main = element("main", {}, ...set.reports.map(reportView));
  const page = document.getElementById("page")!;
  page.append(head);
  if (set.reports.length > 1) {
    const nav = contents(set.reports);
    page.classList.add("with-contents");
    page.append(nav);
    page.append(main);
    followReading(nav, main);
  } else {
    page.append(main);
  }
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
}

start();
