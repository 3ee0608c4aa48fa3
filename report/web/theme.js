"use strict";
// Light and dark: the system's, until the reader chooses. Paper is light.
const theme = (() => {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const listeners = [];
  let chosen = null, printing = false;

  const isDark = () => !printing && (chosen === null ? system.matches : chosen === "dark");
  // Those in force, by name: to ask the document for one makes it work out all its styles anew.
  const properties = new Map();
  function property(name) {
    if (!properties.has(name)) {
      properties.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
    }
    return properties.get(name);
  }

  function apply() {
    properties.clear();
    document.documentElement.dataset.theme = isDark() ? "dark" : "light";
    document.getElementById("theme").textContent = isDark() ? "Light colours" : "Dark colours";
    listeners.forEach(listener => listener());
  }
  document.getElementById("theme").addEventListener("click", () => {
    chosen = isDark() ? "light" : "dark";
    apply();
  });
  system.addEventListener("change", apply);
  for (const [event, begins] of [["beforeprint", true], ["afterprint", false]]) {
    addEventListener(event, () => { printing = begins; apply(); });
  }
  apply();

  return {
    ...makePalette(property),
    isForPaper: () => printing,
    // Returns what ends it.
    onChange: listener => {
      listeners.push(listener);
      return () => listeners.splice(listeners.indexOf(listener), 1);
    },
  };
})();
