// Vega's modules by name, as functions (exports, require, module), and what loads them.
const planbenchModules = {};
const requireModule = (() => {
  const loaded = {};
  return function require(name) {
    // The package vega-selections is in the file vega-selection.
    const source = planbenchModules[name] || planbenchModules[name.replace(/s$/, "")];
    if (!source) throw new Error("no module " + name);
    if (!loaded[name]) {
      const module = {exports: {}};
      loaded[name] = module.exports;
      source(module.exports, require, module);
    }
    return loaded[name];
  };
})();
