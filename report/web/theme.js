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

  return {
    ...makePalette(property),
    // Returns what ends it.
    onChange: listener => {
      listeners.push(listener);
      return () => listeners.splice(listeners.indexOf(listener), 1);
    },
  };
})();
