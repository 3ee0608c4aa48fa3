"use strict";
// Run by node: writes every figure of the data (figures.h) as SVG. Arguments: the data's file, a folder.
const fs = require("fs");
const [dataFile, folder] = process.argv.slice(2);
const data = JSON.parse(fs.readFileSync(dataFile, "utf8"));
const WIDTH = 440;  // one of two columns
const config = {...theme.vegaConfig(WIDTH), background: "white"};
config.legend = {labelColor: theme.property("--text"), labelFontSize: 12, labelFont: config.axis.labelFont, labelLimit: 0};
const AXIS = 60, SYMBOL = 30;  // what an axis of shares takes on the left, and the symbol of an entry, px
requireModule("vega-scenegraph").textMetrics.width = (item, text) => charts.textWidth(String(text ?? ""), item.fontSize);

// Away from the page a figure tells itself what it shows: of which set, how many problems, under which limit, measured on what.
// `problems`: over how many it is, in words.
function titled(spec, title, set, problems) {
  const limits = set.survival.map(one => one.limit).filter(limit => limit > 0).map(limit => limit / 1000);
  const least = Math.min(...limits), most = Math.max(...limits);
  const sessions = data.tables.find(table => table.name === "sessions");
  const processors = sessions ? sessions.rows.filter(row => row[0] === "processor").flatMap(row => row.slice(1)) : [];
  const facts = [problems, limits.length === 0 ? "" : `time limit ${least === most ? least : `${least} to ${most}`} s`, ...new Set(processors)];
  // The title is bold, and wider than its size tells.
  const inLines = (text, fontSize) => charts.lines(text, (WIDTH - 20) * 12 / fontSize);
  return {...spec, title: {
    text: inLines(`${title}: ${set.name}`, 15), subtitle: inLines(facts.filter(fact => fact).join(", "), 11), anchor: "start", frame: "bounds",
    fontSize: 13, subtitleFontSize: 11, offset: 12, color: theme.property("--text"), subtitleColor: theme.property("--muted"),
    font: config.axis.labelFont, subtitleFont: config.axis.labelFont,
  }};
}

function write(name, spec) {
  return vega.view(spec, WIDTH, config, {renderer: "none"}).toSVG().then(svg =>
    fs.writeFileSync(`${folder}/${name}.svg`, svg));
}

// The page has its legends beside the figures.
// `names`: of all contestants.
function withLegend(kind, set, spec, names) {
  const ofCurves = {stroke: "colour", strokeDash: "dash", symbolType: "stroke", symbolStrokeWidth: 2, symbolSize: 300};
  const legend = {
    survival: ofCurves, profile: ofCurves, cost: ofCurves, bound: ofCurves,
    phases: {fill: "colour", symbolType: "square"},
  }[kind];
  if (!legend) return spec;
  const ofPlace = (name, place) => (kind === "cost" && hasOwnCosts(set, place) ? name + " (over its own lowest)" : name);
  // Beside their symbols, and all of it below the plot: what is wider would be cut off.
  const room = columns => (WIDTH - AXIS) / columns - SYMBOL;
  const labels = (kind === "phases" ? charts.PHASES : names.map(ofPlace)).map(label => charts.lines(label, room(1)));
  const columns = labels.flat().every(line => charts.textWidth(line) <= room(2)) ? 2 : 1;
  return {
    ...spec, signals: [...spec.signals, {name: "labels", value: labels}],
    legends: [{...legend, orient: "bottom", columns, encode: {labels: {update: {text: {signal: "labels[datum.value]"}}}}}],
  };
}

const named = new Set();
// A file's name of a set's: "shelf test/1" is shelf_test_1, and what came before is not written over.
function fileName(text) {
  const plain = text.replace(/[^A-Za-z0-9-]+/g, "_");
  let name = plain;
  for (let i = 2; named.has(name); ++i) name = `${plain}_${i}`;
  named.add(name);
  return name;
}

// By which all names of figures begin, whatever the set.
fs.writeFileSync(`${folder}/kinds.json`, JSON.stringify([...Object.keys(figureKinds), ...data.measures.map(measure => measure.name)]));
const written = [];
for (const set of data.sets) {
  const own = fileName(set.name);
  for (const [kind, {title, list, make, problems}] of Object.entries(figureKinds)) {
    const values = list(set);
    if (!values || values.length === 0) continue;
    const places = values.map(value => value.contestant);
    const spec = make(WIDTH, namesOf(data, set, places), places, values, () => {});
    const figure = withLegend(kind, set, spec, namesOf(data, set, [...data.contestants.keys()]));
    written.push(write(`${kind}-${own}`, titled(figure, title, set, problemsTold(data, set, places, problems && problems(set)))));
  }
  data.measures.forEach((measure, kind) => {
    const numbers = set.all ? [] : qualityProblems(set, kind);
    if (numbers.length === 0) return;
    written.push(write(`${measure.name}-${own}`, titled(qualityFigure(WIDTH, data, set, kind), measure.name.replace(/_/g, " "), set,
                                                        problemsTold(data, set, [], numbers))));
  });
}
Promise.all(written).catch(error => {
  console.error(error);
  process.exitCode = 1;
});
