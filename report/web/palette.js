"use strict";
// Colours of figures; property(name) gives a variable of page.css.
function makePalette(property) {
  const DASHES = [[], [9, 3], [2, 2], [9, 3, 2, 3], [9, 3, 2, 3, 2, 3]];
  const NARROW = 480;
  const list = name => property(name).split(",").map(colour => colour.trim());
  const series = () => list("--series");
  return {
    property,
    // Of the contestant at a place: neighbours have other dashes, too, and so has a colour when it comes again.
    colour: index => { const all = series(); return all[index % all.length]; },
    phase: index => list("--phases")[index],
    dash: index => DASHES[index % DASHES.length],
    // Of a figure that is so wide, px.
    vegaConfig: width => {
      const text = property("--text"), muted = property("--muted"), line = property("--line");
      return {
        background: null,
        axis: {
          labelColor: text, titleColor: muted, domainColor: muted, tickColor: muted, gridColor: line,
          gridOpacity: 0.6, labelFontSize: 12, titleFontSize: 12, titleFontWeight: "normal",
          labelLimit: 0, labelOverlap: "greedy", labelSeparation: 6,
          labelFont: "system-ui, sans-serif", titleFont: "system-ui, sans-serif",
        },
        // In a narrow figure titles reach below the labels on the left.
        axisBottom: width < NARROW ? {titleAnchor: "end"} : {},
        text: {fill: text, font: "system-ui, sans-serif", fontSize: 12},
        rule: {stroke: muted},
        style: {cell: {stroke: "transparent"}},
      };
    },
  };
}
