"use strict";
// Figures in the page: made when they come into sight, made anew when colours or width change, and for paper.
const pictures = (() => {
  const all = [];
  const PAPER = 640;  // the width between the margins of most sheets, px
  const tooltip = document.getElementById("tooltip");
  const sight = new IntersectionObserver(entries => {
    for (const entry of entries) if (entry.isIntersecting) render(entry.target.planbenchChart);
  }, {rootMargin: "400px"});

  function render(chart) {
    sight.unobserve(chart.element);
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

  // `height` is kept free until it is made, so that what is below it is out of sight: of its parts without axes, px.
  // make(width): its specification for that width, px.
  function add(element, label, height, make) {
    element.classList.add("chart");
    element.setAttribute("role", "img");
    element.setAttribute("aria-label", label);
    element.style.minHeight = height + "px";
    const chart = {element, label, make, view: null};
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
