"use strict";
// Vega made of its modules, with the transforms that the figures need.
const vega = (() => {
  Object.assign(requireModule("vega-dataflow").transforms, requireModule("vega-transforms"),
                requireModule("vega-view-transforms"), requireModule("vega-encode"));
  const {View} = requireModule("vega-view"), {parse} = requireModule("vega-parser");
  // A view of a figure that is as wide as `width` with all its labels, or as its usermeta.mostWidth if that is less.
  const view = (spec, width, config, options) => new View(
    parse({width: Math.min(width, spec.usermeta ? spec.usermeta.mostWidth : width), autosize: {type: "fit-x", contains: "padding"}, padding: 4, ...spec}, config), {logLevel: 1, ...options});
  return {view};
})();
