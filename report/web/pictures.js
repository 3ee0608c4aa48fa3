"use strict";
// Figures in the page: made when they come into sight, made anew when colours or width change, and for paper.
const pictures = (() => {
  const all = [];
  const PAPER = 640;  // the width between the margins of most sheets, px
  const tooltip = document.getElementById("tooltip"), ring = document.getElementById("ring");
  const sight = new IntersectionObserver(entries => {
    for (const entry of entries) if (entry.isIntersecting) render(entry.target.planbenchChart);
  }, {rootMargin: "400px"});

  function render(chart) {
    sight.unobserve(chart.element);
    if (document.activeElement === chart.element) leave();
    chart.at = -1;
    if (chart.view) chart.view.finalize();
    const width = Math.min(chart.element.clientWidth, theme.isForPaper() ? PAPER : Infinity);
    if (width === 0) return;
    chart.element.style.minHeight = "";
    chart.width = width;
    const spec = {description: chart.label, ...chart.make(width)};
    const numMarks = spec.data.reduce((sum, data) => sum + (data.values || []).length, 0);
    chart.view = vega.view(spec, width, theme.vegaConfig(width), {
      container: chart.element, hover: true, renderer: numMarks > 1500 ? "canvas" : "svg",
      tooltip: (handler, event, item, value) => showTooltip(event, value),
    });
    chart.view.addEventListener("click", (event, item) => {
      if (item && item.datum && item.datum.open) item.datum.open();
    });
    chart.view.run();
  }

  function showTooltip(event, value) {
    tooltip.hidden = value == null || value === "";
    if (tooltip.hidden) return;
    tooltip.textContent = value;
    tooltip.style.left = Math.min(event.clientX + 14, innerWidth - tooltip.offsetWidth - 8) + "px";
    tooltip.style.top = Math.min(event.clientY + 14, innerHeight - tooltip.offsetHeight - 8) + "px";
  }

  // ---- Keyboard: a figure is one stop of the tab key, and in it arrow keys go from mark to mark --------
  // What has a tooltip, in rows by the first line of these, each from left to right, with its place in the figure, px. Of what is
  // drawn of one datum the last, which is on top, and a curve as a whole.
  function marksOf(chart) {
    const found = new Map();
    const visit = (mark, x, y) => mark.items.forEach((item, i) => {
      const isLine = mark.marktype === "line";
      if (mark.marktype === "group") item.items.forEach(child => visit(child, x + (item.x || 0), y + (item.y || 0)));
      else if (item.tooltip && item.opacity !== 0 && (i === 0 || !isLine)) {
        const {x1, y1, x2, y2} = (isLine ? mark : item).bounds;
        found.set(item.datum, {tip: item.tooltip, open: item.datum.open, left: x + x1, top: y + y1, width: x2 - x1, height: y2 - y1});
      }
    });
    const [x, y] = chart.view.origin(), {left, top} = chart.view.padding();
    visit(chart.view.scenegraph().root, x + left, y + top);
    const rows = new Map();
    for (const one of [...found.values()].sort((a, b) => a.left - b.left)) {
      const [name] = one.tip.split("\n");
      if (!rows.has(name)) rows.set(name, []);
      rows.get(name).push(one);
    }
    return [...rows.values()].sort((a, b) => a[0].top - b[0].top).flatMap((row, i) => row.map(one => ({...one, row: i})));
  }

  function reach(chart, event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey || !chart.view) return;  // the browser's own
    const marks = marksOf(chart), now = marks[chart.at];
    const firstOf = row => marks.findIndex(one => one.row === row);
    const row = now ? now.row : -1;
    const to = {ArrowRight: chart.at + 1, ArrowLeft: chart.at - 1, ArrowDown: firstOf(row + 1), ArrowUp: firstOf(row - 1),
                Home: 0, End: marks.length - 1}[event.key];
    if (event.key === "Escape") leave();
    else if ((event.key === "Enter" || event.key === " ") && now && !ring.hidden && now.open) now.open();
    else if (to !== undefined) show(chart, marks, to);
    else return;
    event.preventDefault();
  }

  function show(chart, marks, at) {
    if (!(at in marks)) return;
    chart.at = at;
    const {left, top, width, height, tip} = marks[at];
    const drawn = chart.element.querySelector("svg, canvas").getBoundingClientRect();
    ring.hidden = false;
    Object.assign(ring.style, {left: drawn.left + scrollX + left + "px", top: drawn.top + scrollY + top + "px",
                               width: width + "px", height: height + "px"});
    ring.scrollIntoView({block: "nearest"});
    const box = ring.getBoundingClientRect();
    showTooltip({clientX: box.left + box.width / 2, clientY: box.bottom}, tip);
  }

  function leave() {
    ring.hidden = true;
    showTooltip(null, null);
  }

  // `height` is kept free until it is made, so that what is below it is out of sight: of its parts without axes, px.
  // make(width): its specification for that width, px.
  function add(element, label, height, make) {
    element.classList.add("chart");
    element.setAttribute("role", "application");
    element.setAttribute("aria-label", label + "; arrow keys go from mark to mark, Enter opens");
    element.tabIndex = 0;
    element.style.minHeight = height + "px";
    const chart = {element, label, make, view: null, at: -1};
    element.addEventListener("keydown", event => reach(chart, event));
    element.addEventListener("blur", leave);
    element.planbenchChart = chart;
    all.push(chart);
    sight.observe(element);
    return chart;
  }
  const again = () => all.forEach(chart => { if (chart.view || theme.isForPaper()) render(chart); });
  theme.onChange(again);
  let resizing = 0;
  addEventListener("resize", () => {
    clearTimeout(resizing);
    resizing = setTimeout(() => all.forEach(chart => {
      if (chart.view && chart.element.clientWidth !== chart.width) render(chart);
    }), 150);
  });

  return {add, all, render};
})();
