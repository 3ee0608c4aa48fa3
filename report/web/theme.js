"use strict";
// Light and dark: the system's, until the reader chooses.
const theme = (() => {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const listeners = [];
  let chosen = null;

  const isDark = () => (chosen === null ? system.matches : chosen === "dark");
  const property = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function apply() {
    document.documentElement.dataset.theme = isDark() ? "dark" : "light";
    document.getElementById("theme").textContent = isDark() ? "Light colours" : "Dark colours";
    listeners.forEach(listener => listener());
  }
  document.getElementById("theme").addEventListener("click", () => {
    chosen = isDark() ? "light" : "dark";
    apply();
  });
  system.addEventListener("change", apply);
  apply();

  const DASHES = [[], [7, 3], [2, 2], [9, 3, 2, 3]];
  const series = () => property("--series").split(",").map(colour => colour.trim());
  return {
    property,
    // Returns what ends it.
    onChange: listener => {
      listeners.push(listener);
      return () => listeners.splice(listeners.indexOf(listener), 1);
    },
    // Of the contestant at a place: colours repeat with another dash.
    colour: index => { const all = series(); return all[index % all.length]; },
    dash: index => DASHES[Math.floor(index / series().length) % DASHES.length],
    vegaConfig: () => {
      const text = property("--text"), muted = property("--muted"), line = property("--line");
      return {
        background: null,
        axis: {
          labelColor: text, titleColor: muted, domainColor: muted, tickColor: muted, gridColor: line,
          gridOpacity: 0.6, labelFontSize: 12, titleFontSize: 12, titleFontWeight: "normal", labelLimit: 210,
          labelFont: "system-ui, sans-serif", titleFont: "system-ui, sans-serif",
        },
        text: {fill: text, font: "system-ui, sans-serif", fontSize: 12},
        rule: {stroke: muted},
        style: {cell: {stroke: "transparent"}},
      };
    },
  };
})();
