"use strict";
// Vega specifications of the figures. They place numbers of the data and compute none.
const charts = (() => {
  // ---- Parts ------------------------------------------------------------------------------------
  // Once: it takes as long to make as all points to draw.
  const english = new Intl.NumberFormat("en", {maximumSignificantDigits: 3});
  const shortNumber = value => value == null ? "-" : english.format(value);
  const problems = number => `${number} problem${number === 1 ? "" : "s"}`;
  const percent = share => (100 * share).toFixed(1) + " %";

  // From a power of ten to a little above the largest of positive values, a decade at least.
  function logDomain(values) {
    let low = Infinity, high = 0;
    for (const value of values) {
      if (value > 0) { low = Math.min(low, value); high = Math.max(high, value); }
    }
    if (high === 0) return [1, 10];
    const power = 10 ** Math.floor(Math.log10(low));
    return [power, Math.max(1.15 * high, 10 * power)];
  }
  // That of times on scales that clamp: a time of 0, of which there is no logarithm, stands a decade before all others at least.
  function timeDomain(times) {
    const [low, high] = logDomain(times);
    return [times.includes(0) ? low / 10 : low, high];
  }
  // Powers of ten, with their multiples by 2 and 5 where there are few.
  function logTicks([low, high]) {
    const powers = [];
    for (let p = Math.round(Math.log10(low)); 10 ** p <= high; ++p) powers.push(10 ** p);
    if (powers.length < 3) return powers.flatMap(power => [power, 2 * power, 5 * power]).filter(tick => tick <= high);
    const every = Math.ceil(powers.length / 7);
    return powers.filter((power, i) => i % every === 0);
  }
  const logAxis = (scale, orient, domain, title) =>
    ({scale, orient, title, values: logTicks(domain), grid: true, format: "~r", domain: false, zindex: 0,
      encode: {labels: {update: {text: {signal: "format(datum.value, datum.value < 1 ? '~g' : ',')"}}}}});

  // About how wide a text is in a sans-serif, px: where figures are printed nothing measures it.
  function textWidth(text, fontSize = 12) {
    const letterWidth = letter => (/[ ,.:;'!|()[\]fijlrtI-]/.test(letter) ? 0.36 :
                                   /[MWmw%@&]/.test(letter) || letter.codePointAt(0) >= 0x1100 ? 1 :
                                   /[A-Z]/.test(letter) ? 0.8 : 0.64);
    return [...text].reduce((sum, letter) => sum + fontSize * letterWidth(letter), 0);
  }

  // A text in lines about so wide at most, px, broken behind commas, else at spaces, else anywhere. Nothing is cut: of a sweep's
  // names the ends differ.
  function lines(text, most, [pieces, ...finer] = [/.*?, |.+/gs, /.*? |.+/gs, /./gsu]) {
    const fits = line => textWidth(line.trimEnd()) <= most;
    const made = [];
    for (const piece of text.match(pieces) || []) {
      const longer = (made[made.length - 1] || "") + piece;
      if (fits(longer)) made.splice(-1, 1, longer);
      else made.push(...(fits(piece) ? [piece] : lines(piece, most, finer)));
    }
    return made;
  }

  // One row a contestant, whose name takes less than half of a figure so wide, px.
  const rowNames = (names, width) => names.map(name => lines(name, Math.max(80, 0.4 * width)));
  const LINE = 13;
  // A row is as high as its name; what is drawn in it is in a band about its middle, of one height in all, px.
  const bandHeight = names => (names.length > 12 ? 19 : 27);
  const rowHeight = (names, name) => Math.max(1.25 * bandHeight(names), LINE * name.length + 8);
  // Without the width that of a figure beside another in the page.
  const rowsHeight = (names, width = 544) =>
    rowNames(names, width).reduce((sum, name) => sum + rowHeight(names, name), 0);
  function rows(names, width) {
    const broken = rowNames(names, width);
    let end = 0;
    const middles = broken.map(name => (end += rowHeight(names, name)) - rowHeight(names, name) / 2);
    return {
      height: end, band: bandHeight(names),
      scale: {name: "y", type: "ordinal", domain: names.map((name, i) => i), range: middles},
      axis: {scale: "y", orient: "left", ticks: false, domain: false, labelPadding: 8, labelOverlap: false,
             encode: {labels: {update: {
               text: {signal: "names[datum.value]"}, lineHeight: {value: LINE},
               dy: {signal: `${-LINE / 2} * (length(names[datum.value]) - 1)`}}}}},
      signal: {name: "names", value: broken},
    };
  }
  // A range of x that leaves a column free on the right, and is none the other way round where there is no room.
  const besideColumn = column => [0, {signal: `max(width - ${column}, 40)`}];

  // ---- Figures ----------------------------------------------------------------------------------
  // Those of rows are told how wide they will be with all their labels, px.
  // rows: [{share, lower, upper, claimed_share, tip, contestant}]
  function success(width, names, places, values) {
    const r = rows(names, width);
    const data = values.map((value, i) => ({
      ...value, y: i, colour: theme.colour(places[i]),
      tip: `${names[i]}\nconfirmed ${percent(value.share)}, 95 % interval ${percent(value.lower)} to ` +
           `${percent(value.upper)}\nclaimed ${value.claimed}, confirmed ${value.confirmed} of ${value.runs} runs`,
    }));
    return {
      height: r.height, signals: [r.signal], data: [{name: "rows", values: data}],
      scales: [r.scale, {name: "x", type: "linear", domain: [0, 1], range: "width"}],
      axes: [r.axis, {scale: "x", orient: "bottom", format: "%", grid: true, domain: false, tickCount: 5,
                      title: "problems with a confirmed path"}],
      marks: [
        {type: "rule", from: {data: "rows"}, encode: {update: {
          y: {scale: "y", field: "y"}, x: {scale: "x", field: "lower"}, x2: {scale: "x", field: "upper"},
          stroke: {field: "colour"}, strokeWidth: {value: 3}, strokeCap: {value: "round"}, tooltip: {field: "tip"}}}},
        {type: "symbol", name: "claimed", from: {data: "rows"}, encode: {update: {
          y: {scale: "y", field: "y"}, x: {scale: "x", field: "claimed_share"}, shape: {value: "diamond"}, size: {value: 130},
          fill: {value: "transparent"}, stroke: {value: theme.property("--text")}, strokeWidth: {value: 1.5},
          opacity: {signal: "datum.claimed > datum.confirmed ? 1 : 0"}, tooltip: {field: "tip"}}}},
        {type: "symbol", name: "confirmed", from: {data: "rows"}, encode: {update: {
          y: {scale: "y", field: "y"}, x: {scale: "x", field: "share"}, size: {value: 90}, fill: {field: "colour"},
          stroke: {value: theme.property("--background")}, tooltip: {field: "tip"}}}},
      ],
    };
  }

  // values: [{problem: [], trial: [], time: [], median, lower, upper, limit}]; open(problem) shows one.
  function times(width, names, places, values, open) {
    const r = rows(names, width);
    const runs = [], medians = [], failed = [];
    values.forEach((value, y) => {
      let numFailed = 0;
      const colour = theme.colour(places[y]);
      value.time.forEach((time, i) => {
        if (time == null) ++numFailed;
        runs.push({
          y, time, colour, jitter: ((i * 0.6180339887) % 1) - 0.5,
          sideways: ((i * 0.7548776662) % 1) - 0.5,
          tip: `${names[y]}\nproblem ${value.problem[i]}, trial ${value.trial[i]}\n` +
               (time == null ? "not solved" : shortNumber(time) + " ms"),
          open: () => open(value.problem[i]),
        });
      });
      if (numFailed > 0) failed.push({y, text: String(numFailed)});
      if (value.median != null) {
        medians.push({y, median: value.median, lower: value.lower, upper: value.upper,
                      tip: `${names[y]}\nmedian of the solved problems ${shortNumber(value.median)} ms` +
                           (value.lower == null ? "" : `, 95 % interval ${shortNumber(value.lower)} to ` +
                                                       shortNumber(value.upper))});
      }
    });
    const limits = values.map(value => value.limit);
    const limit = Math.max(...limits);  // 0: not known
    const crowded = Math.max(...values.map(value => value.time.length)) > 150;
    const solved = runs.map(run => run.time).filter(time => time != null);
    const domain = timeDomain(limit > 0 ? [...solved, limit] : solved);
    const column = 86;
    const jittered = {scale: "y", field: "y", offset: {signal: `datum.jitter * ${0.8 * r.band}`}};
    return {
      height: r.height, signals: [r.signal],
      data: [
        {name: "solved", values: runs.filter(run => run.time != null)},
        {name: "failed", values: runs.filter(run => run.time == null)},
        {name: "medians", values: medians}, {name: "intervals", values: medians.filter(one => one.lower != null)},
        {name: "counts", values: failed},
      ],
      scales: [r.scale, {name: "x", type: "log", domain, range: besideColumn(column), clamp: true}],
      axes: [r.axis, logAxis("x", "bottom", domain, "planning time, ms")],
      marks: [
        ...(limit > 0 ? [
          {type: "rule", name: "limit", encode: {update: {
            x: {scale: "x", value: limit}, y: {value: 0}, y2: {signal: "height"}, strokeDash: {value: [4, 3]}}}},
          {type: "text", encode: {update: {
            x: {scale: "x", value: limit}, y: {value: -4}, align: {value: "right"},
            text: {value: limits.every(one => one === limit) ? "limit" : "longest limit"}}}}] : []),
        {type: "text", encode: {update: {
          x: {signal: "width"}, y: {value: -4}, align: {value: "right"}, text: {value: "not solved"}}}},
        {type: "symbol", name: "solved-runs", from: {data: "solved"}, encode: {update: {
          y: jittered, x: {scale: "x", field: "time"}, size: {value: crowded ? 9 : 22}, fill: {field: "colour"}, fillOpacity: {value: 0.45},
          cursor: {value: "pointer"}, tooltip: {field: "tip"}}}},
        {type: "symbol", name: "failed-runs", from: {data: "failed"}, encode: {update: {
          y: jittered, x: {signal: `width - ${column - 46} + datum.sideways * 40`}, shape: {value: "M-1,-1L1,1M-1,1L1,-1"},
          size: {value: crowded ? 14 : 45}, stroke: {value: theme.property("--failure")}, strokeWidth: {value: 1.3},
          strokeOpacity: {value: 0.7}, cursor: {value: "pointer"}, tooltip: {field: "tip"}}}},
        {type: "text", from: {data: "counts"}, encode: {update: {
          y: {scale: "y", field: "y"}, x: {signal: "width"}, align: {value: "right"}, baseline: {value: "middle"},
          text: {field: "text"}}}},
        {type: "rule", from: {data: "intervals"}, encode: {update: {
          y: {scale: "y", field: "y"}, x: {scale: "x", field: "lower"}, x2: {scale: "x", field: "upper"}, stroke: {value: theme.property("--text")},
          strokeWidth: {value: 2}}}},
        {type: "symbol", name: "median", from: {data: "medians"}, encode: {update: {
          y: {scale: "y", field: "y"}, x: {scale: "x", field: "median"}, shape: {value: "diamond"}, size: {value: 95},
          fill: {value: theme.property("--background")}, stroke: {value: theme.property("--text")},
          strokeWidth: {value: 2}, tooltip: {field: "tip"}}}},
      ],
    };
  }

  const CURVES_HEIGHT = 260;
  // Curves: [{place, name, x: [], share: [], lower: [], upper: [], end}] on a log axis from `first` to `last`, where what comes
  // before it, as a time of 0, stands at its beginning. Nothing is known of a curve behind its `end`, by default `last`. Shares, which
  // are 0 until the first step, unless `range` tells that of the values; null: none.
  function curves(list, {first, last, title, share, range}) {
    const band = list.length > 6 ? 0 : list.length > 3 ? 0.08 : 0.14;
    const values = [];
    for (const curve of list) {
      const point = (x, i) => ({
        name: curve.name, place: curve.place, x: Math.max(x, first), share: i < 0 ? 0 : curve.share[i],
        lower: !curve.lower || i < 0 ? 0 : curve.lower[i], upper: !curve.upper || i < 0 ? 0 : curve.upper[i],
        tip: curve.name,
      });
      if (!range && (curve.x.length === 0 || curve.x[0] > first)) values.push(point(first, -1));
      curve.x.forEach((x, i) => values.push(point(x, i)));
      const end = Math.min(curve.end ?? last, last);
      if (curve.x.length === 0 || curve.x[curve.x.length - 1] < end) values.push(point(end, curve.x.length - 1));
    }
    const places = list.map(curve => curve.place);
    const domain = [first, last], wide = range && range[1] > 20;
    return {
      height: CURVES_HEIGHT,
      signals: [{name: "focus", value: null}],
      data: [{name: "steps", values}],
      scales: [
        {name: "x", type: "log", domain, range: "width"},
        {name: "y", type: wide ? "log" : "linear", domain: range || [0, 1], zero: false, range: "height", clamp: true},
        {name: "colour", type: "ordinal", domain: places, range: places.map(theme.colour)},
        {name: "dash", type: "ordinal", domain: places, range: places.map(theme.dash)},
      ],
      axes: [logAxis("x", "bottom", domain, title),
             wide ? logAxis("y", "left", range, share) :
                    {scale: "y", orient: "left", format: range ? "~r" : "%", grid: true, domain: false, tickCount: 5, title: share}],
      marks: [{
        type: "group", from: {facet: {name: "curve", data: "steps", groupby: "place"}},
        marks: [
          {type: "area", from: {data: "curve"}, interactive: false, encode: {update: {
            x: {scale: "x", field: "x"}, y: {scale: "y", field: "lower"}, defined: {signal: "datum.share !== null"},
            y2: {signal: "datum.upper === null ? 0 : scale('y', datum.upper)"},
            interpolate: {value: "step-after"}, fill: {scale: "colour", field: "place"},
            fillOpacity: {signal: `focus === null ? ${band} : focus === datum.place ? 0.22 : 0`}}}},
          {type: "line", from: {data: "curve"}, encode: {update: {
            x: {scale: "x", field: "x"}, y: {scale: "y", field: "share"}, defined: {signal: "datum.share !== null"}, interpolate: {value: "step-after"},
            stroke: {scale: "colour", field: "place"}, strokeDash: {scale: "dash", field: "place"},
            strokeWidth: {signal: "focus === datum.place ? 3.5 : 2"}, tooltip: {field: "tip"},
            strokeOpacity: {signal: "focus === null || focus === datum.place ? 1 : 0.2"}}}},
        ],
      }],
    };
  }

  const SCATTER_SIDE = 380;
  // points: [{x, y, label, open}], times in ms, null where not solved.
  function scatter(points, first, second, limit) {
    const solved = points.flatMap(point => [point.x, point.y]).filter(time => time != null);
    const domain = timeDomain(limit > 0 ? [...solved, limit] : solved);
    const side = SCATTER_SIDE, column = 34, titleWidth = 280;
    const place = (field, range) => `datum.${field} === null ? ${range} : scale('${field}', datum.${field})`;
    const values = points.map(point => ({
      ...point, both: point.x != null && point.y != null,
      tip: `${point.label}\n${first}: ${point.x == null ? "not solved" : shortNumber(point.x) + " ms"}\n` +
           `${second}: ${point.y == null ? "not solved" : shortNumber(point.y) + " ms"}`,
    }));
    return {
      usermeta: {mostWidth: side + 90}, height: side,
      data: [{name: "points", values}, {name: "ends", values: domain.map(end => ({end}))}],
      scales: [{name: "x", type: "log", domain, range: besideColumn(column), clamp: true},
               {name: "y", type: "log", domain, range: [{signal: "height"}, column], clamp: true}],
      axes: [logAxis("x", "bottom", domain, lines(first + ", ms", titleWidth)),
             logAxis("y", "left", domain, lines(second + ", ms", titleWidth))],
      marks: [
        {type: "line", from: {data: "ends"}, encode: {update: {
          x: {scale: "x", field: "end"}, y: {scale: "y", field: "end"}, stroke: {value: theme.property("--muted")}}}},
        {type: "rule", encode: {update: {x: {signal: `width - ${column}`}, y: {value: 0}, y2: {signal: "height"},
                                         strokeDash: {value: [4, 3]}}}},
        {type: "rule", encode: {update: {y: {value: column}, x: {value: 0}, x2: {signal: "width"},
                                         strokeDash: {value: [4, 3]}}}},
        {type: "text", encode: {update: {x: {signal: "width - 2"}, y: {signal: "height - 6"}, angle: {value: -90},
                                         text: {value: "not solved"}}}},
        {type: "text", encode: {update: {x: {value: 4}, y: {value: 12}, text: {value: "not solved"}}}},
        {type: "symbol", name: "problems", from: {data: "points"}, encode: {update: {
          x: {signal: place("x", `width - ${column / 2}`)}, y: {signal: place("y", column / 2)}, size: {value: 34},
          fill: {signal: `datum.both ? '${theme.property("--accent")}' : '${theme.property("--failure")}'`},
          fillOpacity: {value: 0.75}, cursor: {value: "pointer"}, tooltip: {field: "tip"}}}},
      ],
    };
  }

  // Quartiles and median, raw above simplified: [{contestant, lower, median, upper}] each.
  function quality(width, names, places, raw, simplified, title) {
    const r = rows(names, width);
    const values = [];
    const collect = (list, kind, shift) => list.forEach(one => {
      const y = places.indexOf(one.contestant);
      values.push({...one, y, kind, shift, colour: theme.colour(one.contestant),
                   tip: `${names[y]}, ${kind}\nmedian ${shortNumber(one.median)}, quartiles ` +
                        `${shortNumber(one.lower)} to ${shortNumber(one.upper)}\n${problems(one.problems)}`});
    });
    collect(raw, "raw", -0.22);
    collect(simplified, "simplified", 0.22);
    const y = {scale: "y", field: "y", offset: {signal: `datum.shift * ${r.band}`}};
    return {
      height: r.height, signals: [r.signal], data: [{name: "values", values}],
      scales: [r.scale, {name: "x", type: "linear", zero: true, nice: true, range: "width",
                         domain: {data: "values", fields: ["lower", "upper"]}}],
      axes: [r.axis, {scale: "x", orient: "bottom", grid: true, domain: false, tickCount: 6, title}],
      marks: [
        {type: "rule", from: {data: "values"}, encode: {update: {
          y, x: {scale: "x", field: "lower"}, x2: {scale: "x", field: "upper"}, stroke: {field: "colour"},
          strokeWidth: {value: 3}, strokeCap: {value: "round"}, tooltip: {field: "tip"}}}},
        {type: "symbol", name: "median", from: {data: "values"}, encode: {update: {
          y, x: {scale: "x", field: "median"}, size: {value: 80}, strokeWidth: {value: 2}, stroke: {field: "colour"},
          fill: {signal: `datum.kind === 'raw' ? datum.colour : '${theme.property("--background")}'`},
          tooltip: {field: "tip"}}}},
      ],
    };
  }

  const PHASES = ["set-up", "collision checking", "guidance", "search"];
  function phases(width, names, values) {
    const r = rows(names, width);
    const data = values.flatMap((value, y) => {
      let sum = 0;
      return value.shares.map((share, phase) => {
        const begin = sum;
        sum += share;
        return {y, phase, begin, end: sum, tip: `${names[y]}\n${PHASES[phase]}: ${percent(share)} of ` +
                                                 `${shortNumber(value.total)} ms`};
      });
    });
    return {
      height: r.height, signals: [r.signal],
      data: [{name: "parts", values: data},
             {name: "totals", values: values.map((value, y) => ({y, text: shortNumber(value.total) + " ms"}))}],
      scales: [r.scale, {name: "x", type: "linear", domain: [0, 1], range: besideColumn(74)},
               {name: "colour", type: "ordinal", domain: [0, 1, 2, 3], range: [0, 1, 2, 3].map(theme.phase)}],
      axes: [r.axis, {scale: "x", orient: "bottom", format: "%", tickCount: {signal: "width < 300 ? 2 : 5"}, domain: false,
                      title: "share of the time to the end of the search"}],
      marks: [
        {type: "rect", from: {data: "parts"}, encode: {update: {
          y: {scale: "y", field: "y", offset: -r.band / 2}, height: {value: r.band}, x: {scale: "x", field: "begin"},
          x2: {scale: "x", field: "end"}, fill: {scale: "colour", field: "phase"},
          stroke: {value: theme.property("--background")}, tooltip: {field: "tip"}}}},
        {type: "text", from: {data: "totals"}, encode: {update: {
          y: {scale: "y", field: "y"}, x: {signal: "width"}, align: {value: "right"}, baseline: {value: "middle"},
          text: {field: "text"}}}},
      ],
    };
  }

  return {
    logDomain, textWidth, lines, problems, success, times, curves, scatter, quality, phases, PHASES,
    // Heights of figures without their axes, px.
    rowsHeight, CURVES_HEIGHT, SCATTER_SIDE,
  };
})();
