"use strict";
const curvesHeight = () => charts.CURVES_HEIGHT;
// The kinds of figures that there are for each set: of what values they are made, [{contestant, ...}], and how, if they are to be
// `width` px wide; how high they are of contestants with these names, without axes, px; of how many problems the values are, where
// these are not all that their contestant tried. `names` and `places` are those of the values' contestants; open(problem) is what a
// point of a run leads to.
const figureKinds = {
  success: {
    title: "Success", height: charts.rowsHeight,
    list: set => set.success,
    make: (width, names, places, values) => charts.success(width, names, places, values),
  },
  times: {
    title: "Planning time of every run", height: charts.rowsHeight,
    list: set => set.times,
    make: (width, names, places, values, open) => charts.times(width, names, places, values, open),
  },
  survival: {
    title: "Share solved by a time", height: curvesHeight,
    list: set => set.survival.filter(value => endOf(value) > 0),
    make: (width, names, places, values) => {
      const list = values.map((value, i) => ({...value, place: places[i], name: names[i], x: value.time, end: endOf(value)}));
      const last = Math.max(...list.map(curve => curve.end));
      // Where the first of them rises, or ends.
      const rise = charts.logDomain([...list.map(curve => curve.end), ...values.flatMap(value => value.time.slice(0, 2))])[0];
      const first = last < 2 * rise ? rise / 10 : rise;
      return charts.curves(list, {first, last, title: "time, ms", share: "solved"});
    },
  },
  profile: {
    title: "Performance profile", height: curvesHeight,
    list: set => (set.profile_problems > 0 ? set.profile : []), problems: set => [set.profile_problems],
    make: (width, names, places, values) => {
      const last = charts.logDomain([1, ...values.flatMap(value => value.ratio.slice(-1))])[1];
      return charts.curves(values.map((value, i) => ({...value, place: places[i], name: names[i], x: value.ratio})),
                           {first: 1, last, title: "time over that of the fastest", share: "problems"});
    },
  },
  cost: {
    title: "Cost over time", height: curvesHeight,
    list: set => set.anytime_cost,
    make: (width, names, places, values) => improvement(names, places, values, "cost over the lowest found"),
  },
  bound: {
    title: "Proven bound over time", height: curvesHeight,
    list: set => set.anytime_bound,
    make: (width, names, places, values) => improvement(names, places, values, "proven bound"),
  },
  phases: {
    title: "Where the time goes", height: charts.rowsHeight,
    list: set => set.phases, problems: set => set.phases.map(value => value.problems),
    make: (width, names, places, values) => charts.phases(width, names, values),
  },
};

// Until when something is known of a contestant, ms: its time limit, or the last time there is, where attempts before it failed.
const endOf = value => Math.max(value.limit, ...value.time.slice(-1));

// Whether a contestant's costs on a set are of a kind of its own, and over its own lowest.
const hasOwnCosts = (set, place) => (set.anytime_cost || []).some(one => one.contestant === place && one.own_costs);

function improvement(names, places, values, title) {
  const numbers = values.flatMap(value => value.median.concat(value.upper)).filter(one => one !== null);
  return charts.curves(values.map((value, i) => ({...value, place: places[i], name: names[i], x: value.time, share: value.median,
                                                    end: endOf(value)})), {
    first: Math.min(...values.map(value => value.time[0])), last: Math.max(...values.map(value => value.time[value.time.length - 1])),
    title: "time, ms", share: title, range: [1, Math.max(1.1, ...numbers)],
  });
}

// What a contestant is called where these sets are shown: with a mark if it has learned from all, or from which, that it is tried on.
function nameIn(data, sets, place) {
  const {name} = data.contestants[place];
  const trained = sets.filter(set => set.trained.includes(place));
  if (trained.length === 0) return name;
  const tried = sets.filter(set => set.survival.some(one => one.contestant === place));
  return name + (trained.length === tried.length ? " (trained)" : ` (trained on ${trained.map(set => set.name).join(", ")})`);
}
const namesOf = (data, set, places) => places.map(place => nameIn(data, [set], place));

// Over how many of a set's problems a figure is, in words; `numbers`: of them, of each value, or else those that the contestants at
// `places` tried.
function problemsTold(data, set, places, numbers) {
  const ofSets = set.all ? data.sets.filter(one => !one.all) : [set];
  const sum = count => ofSets.reduce((total, one) => total + count(one.problem_times), 0);
  const all = sum(times => new Set(times.flatMap(one => one.problem)).size);
  const shown = numbers || places.map(place =>
    sum(times => times.filter(one => one.contestant === place).reduce((total, one) => total + one.problem.length, 0)));
  const least = Math.min(...shown), most = Math.max(...shown);
  if (least === all) return charts.problems(all);
  return `${least === most ? least : `${least} to ${most}`} of ${charts.problems(all)}`;
}

// Of each value of a measure on a set the number of its problems, by the measure's place in data.measures.
const qualityProblems = (set, kind) => {
  const {raw, simplified} = set.quality[kind];
  return raw.concat(simplified).map(one => one.problems);
};

// The figure of a measure on a set, by the measure's place in data.measures.
function qualityFigure(width, data, set, kind) {
  const {raw, simplified} = set.quality[kind];
  const places = data.contestants.map((contestant, place) => place).filter(place =>
    raw.concat(simplified).some(one => one.contestant === place));
  const {name, unit} = data.measures[kind];
  return charts.quality(width, namesOf(data, set, places), places, raw, simplified,
                        name.replace(/_/g, " ") + (unit ? ", " + unit : ""));
}
