"use strict";
// Lays the data out: sections in the order in which a reader asks, tables, figures, and what the reader picks.
const report = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const main = document.getElementById("main");
  const sets = data.sets.filter(set => !set.all);
  // Those of the data, by which tables are searched, and those shown beside all sets.
  const plainNames = data.contestants.map(contestant => contestant.name);
  const names = plainNames.map((name, place) => nameIn(data, sets, place));
  const tables = Object.fromEntries(data.tables.map(table => [table.name, table]));

  // ---- Elements ---------------------------------------------------------------------------------
  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.append(...children);
    return made;
  }

  function section(id, title, ...children) {
    document.getElementById("contents").append(element("li", {}, element("a", {href: "#" + id}, title)));
    const made = element("section", {id, "aria-labelledby": id + "-title"}, element("h2", {id: id + "-title"}, title),
                         ...children);
    main.append(made);
    return made;
  }

  // Rows of one set stand together below its name.
  // `cellOf(row, heading, text)` may put elements in the place of a cell's text.
  function tableElement({title, columns, rows}, cellOf = (row, heading, text) => [text]) {
    const grouped = columns[0].heading === "set" ? 1 : 0;
    const shown = columns.slice(grouped);
    const cell = (tag, text, column, content = [text]) => {
      const kind = column.numeric ? "numeric" : text.length > 40 || /\S{17}/.test(text) ? "" : "short";
      return element(tag, {class: kind, ...(tag === "th" ? {scope: "col"} : {})}, ...content);
    };
    const body = element("tbody");
    let group = null;
    for (const row of rows) {
      if (grouped && row[0] !== group) {
        group = row[0];
        body.append(element("tr", {}, element("th", {colspan: String(shown.length), scope: "colgroup"}, group)));
      }
      body.append(element("tr", {}, ...row.slice(grouped).map((text, i) =>
        cell("td", text, shown[i], cellOf(row, shown[i].heading, text)))));
    }
    return element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": title},
                   element("table", {}, element("thead", {}, element("tr", {}, ...shown.map(column =>
                     cell("th", column.heading, column)))), body));
  }

  // A table with the note on how it was computed; `open`: seen at once. Others can be most of a page, and are made when they
  // are opened.
  function tableBlock(name, open, cellOf) {
    const table = tables[name];
    if (!table) return element("p", {class: "note"}, "Nothing to show.");
    const parts = () => [tableElement(table, cellOf), element("p", {class: "note"}, table.note)];
    if (open) return element("div", {}, ...parts());
    const block = element("details", {}, element("summary", {}, `Table: ${table.title}`));
    block.addEventListener("toggle", () => block.append(...parts()), {once: true});
    return block;
  }

  // On paper nothing can be opened.
  const closed = [];
  addEventListener("beforeprint", () => {
    for (const details of document.querySelectorAll("details:not([open])")) {
      details.dispatchEvent(new Event("toggle"));  // its own comes when the sheet has been laid out
      details.open = true;
      closed.push(details);
    }
  });
  addEventListener("afterprint", () => closed.splice(0).forEach(details => { details.open = false; }));

  // `name`: what it shows, for who cannot see it.
  function figure(title, name, height, make) {
    const chart = element("div");
    const made = element("figure", {}, element("h3", {}, title), chart);
    pictures.add(chart, name, height, make);
    return made;
  }

  // A figure of a kind for each set of which there is anything.
  function figuresOfSets(kind) {
    const {list, make, title, height, problems} = figureKinds[kind];
    const grid = element("div", {class: "grid"});
    for (const set of data.sets) {
      const values = list(set);
      if (!values || values.length === 0) continue;
      const places = values.map(value => value.contestant);
      const names = namesOf(data, set, places);
      const told = problems ? `${set.name}: ${problemsTold(data, set, places, problems(set))}` : set.name;
      grid.append(figure(told, `${title}, ${set.name}`, height(names), width =>
        make(width, names, places, values, problem => showProblem(sets.indexOf(set), problem))));
    }
    return grid;
  }

  const note = text => element("p", {class: "note"}, text);
  // Beside every ratio of times, where time limits differ.
  const limitsNote = () => (data.limits_note ? [note(data.limits_note)] : []);

  function select(label, options, chosen, onChange) {
    const made = element("select");
    options.forEach((option, i) => made.append(element("option", {value: String(i)}, option)));
    made.value = String(chosen);
    made.addEventListener("change", () => onChange(Number(made.value)));
    return element("label", {}, label, made);
  }

  function swatch(colour, dash = () => []) {
    const line = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    line.setAttribute("class", "swatch");
    line.setAttribute("viewBox", "0 0 38 12");
    line.setAttribute("aria-hidden", "true");
    const stroke = document.createElementNS("http://www.w3.org/2000/svg", "path");
    stroke.setAttribute("d", "M0,6H38");
    stroke.setAttribute("stroke-width", "3");
    const paint = () => {
      stroke.setAttribute("stroke", colour());
      stroke.setAttribute("stroke-dasharray", dash().join(","));
    };
    paint();
    theme.onChange(paint);
    line.append(stroke);
    return line;
  }

  const contestantSwatch = place => swatch(() => theme.colour(place), () => theme.dash(place));

  // Buttons that bring one contestant's curves out in the charts of an element.
  function legend(container) {
    let pressed = null;
    const list = element("ul", {class: "legend", "aria-label": "Contestants; choose one to bring it out"});
    const show = place => {
      for (const chart of pictures.all) {
        if (chart.view && container().contains(chart.element)) chart.view.signal("focus", place).run();
      }
    };
    names.forEach((name, place) => {
      const button = element("button", {type: "button", "aria-pressed": "false"}, contestantSwatch(place), name);
      button.addEventListener("click", () => {
        pressed = pressed === place ? null : place;
        list.querySelectorAll("button").forEach((other, i) => other.setAttribute("aria-pressed", String(i === pressed)));
        show(pressed);
      });
      button.addEventListener("mouseenter", () => show(place));
      button.addEventListener("mouseleave", () => show(pressed));
      list.append(element("li", {}, button));
    });
    return list;
  }

  // ---- Sections ---------------------------------------------------------------------------------
  function answer() {
    section("answer", "The answer", ...data.answer.map(sentence => element("p", {}, sentence)), ...limitsNote());
  }

  function compared() {
    const made = section("compared", "What was compared");
    if (tables.sessions) made.append(tableElement(tables.sessions));
    if (data.differences) {
      made.append(element("h3", {}, "Where the sessions differ"), tableElement(data.differences));
    }
    if (tables.changes) made.append(element("h3", {}, tables.changes.title), tableBlock("changes", true));
    made.append(note("Contestants, in the order of their penalised mean time over the problems that all of them tried, or, if there are none, over what each tried; each opens to its settings."));
    data.contestants.forEach((contestant, place) => {
      made.append(element("details", {}, element("summary", {}, contestantSwatch(place), " " + names[place]),
                          element("pre", {tabindex: "0"}, contestant.settings)));
    });
  }

  function success() {
    section("success", "Success",
      note("Dot: share of the problems with a path that the referee confirmed; line: its 95 % interval. A hollow diamond is " +
           "the same of paths that the planner claimed, where that is more."),
      figuresOfSets("success"),
      tableBlock("success", true));
  }

  function times() {
    const made = section("times", "Planning time",
      note("Every run is a point: the time to its first confirmed path, failed attempts before it included. A run without one is a " +
           "cross in the column on the right, with their number, whenever it ended. Diamond: median over the solved " +
           "problems, with its 95 % interval. A time of 0 stands at the left end. A point opens its problem."),
      figuresOfSets("times"),
      tableBlock("times", true),
      ...(tables.directions ? [tableBlock("directions", false)] : []),
      element("h3", {}, "Share solved by a time"),
      note("Mean over the problems of the share of their trials that have a confirmed path by then; bands are Wilson's 95 % " +
           "intervals of each time by itself, for as many cases as there are problems. With more than six contestants a band " +
           "shows where its contestant is brought out. A curve ends at its contestant's own time limit, or where its last run " +
           "succeeded: nothing is known of it behind that."));
    const grid = figuresOfSets("survival");
    made.append(legend(() => grid), grid);
  }

  // Times of the problems of a set that both tried, with what opens them.
  function pairPoints(set, first, second) {
    return (set.all ? sets : [set]).flatMap(one => {
      const of = place => one.problem_times.find(times => times.contestant === place);
      const a = of(first), b = of(second);
      if (!a || !b) return [];
      const other = new Map(b.problem.map((problem, i) => [problem, b.time[i]]));
      return a.problem.flatMap((problem, i) => other.has(problem) ? [{
        x: a.time[i], y: other.get(problem), label: `${one.name}, problem ${problem}`,
        open: () => showProblem(sets.indexOf(one), problem),
      }] : []);
    });
  }

  function pairs() {
    const made = section("pairs", "Problem by problem");
    if (names.length < 2) {
      made.append(note("There is one contestant: nothing to compare it with."));
      return;
    }
    let set = data.sets.length - 1, first = 0, second = 1;
    const chart = element("div");
    const figure = element("div");
    const shown = pictures.add(chart, "Times of two contestants, problem by problem", charts.SCATTER_SIDE, () => charts.scatter(
      pairPoints(data.sets[set], first, second), ...namesOf(data, data.sets[set], [first, second]),
      Math.max(...data.sets[set].survival.map(value => value.limit))));
    function update() {
      // The table holds each pair once, the higher rank first.
      if (first > second) [first, second] = [second, first];
      const row = (tables.pairs ? tables.pairs.rows : []).filter(row =>
        row[0] === data.sets[set].name && row[1] === plainNames[first] && row[2] === plainNames[second]);
      const choices = namesOf(data, data.sets[set], [...names.keys()]);
      figure.replaceChildren(
        element("div", {class: "controls"},
          select("set", data.sets.map(one => one.name), set, value => { set = value; update(); }),
          select("first", choices, first, value => { second = value === second ? first : second; first = value; update(); }),
          select("second", choices, second, value => { first = value === first ? second : first; second = value; update(); })),
        row.length > 0 ? tableElement({...tables.pairs, rows: row}) : note("These two have no problem of this set in common."));
      if (shown.view) pictures.render(shown);
    }
    update();
    made.append(figure, element("figure", {class: "beside"}, chart, element("figcaption", {},
        "A point is a problem, at the medians of its trials; below the diagonal the second is faster. In the strips " +
        "on the right and at the top one or both did not solve it in the median. A time of 0 stands where its axis begins. A point opens its problem.")), ...limitsNote());
    made.append(tableBlock("pairs", false));
    made.append(element("h3", {}, "Performance profiles"),
      note("Share of the problems on which a contestant is within a ratio of the fastest of all (Dolan and Moré 2002), over the " +
           "problems that all tried; at ratio 1 the share on which it is the fastest, at the right end the share of the problems that it solved in the median " +
           "of their trials. Problems at which a time is 0 are left out."),
      ...limitsNote());
    const grid = figuresOfSets("profile");
    made.append(...(grid.hasChildNodes() ? [legend(() => grid), grid] : [note("There is none of which all have a time.")]));
  }

  function quality() {
    const made = section("quality", "Path quality");
    const kinds = data.measures.map((measure, i) => i).filter(i => sets.some(set => qualityProblems(set, i).length > 0));
    if (kinds.length === 0) {
      made.append(note("No path was measured."));
      return;
    }
    let kind = kinds[0];
    const grid = element("div", {class: "grid"});
    const meaning = note("");
    const shown = [];
    for (const set of sets) {
      if (kinds.every(i => qualityProblems(set, i).length === 0)) continue;
      const chart = element("div");
      grid.append(element("figure", {}, element("h3", {}, set.name), chart));
      shown.push(pictures.add(chart, "Path quality, " + set.name, charts.rowsHeight(names),
                              width => qualityFigure(width, data, set, kind)));
    }
    function update() {
      meaning.textContent = `${data.measures[kind].name.replace(/_/g, " ")}: ${data.measures[kind].meaning}. Filled: the path ` +
        "as planned; hollow: simplified, as each planner does it. Median and quartiles over the problems of which each " +
        "has such a path measured, of medians over its runs: the problems are not the same for all; the table has ratios over those that two have.";
      shown.forEach(chart => { if (chart.view) pictures.render(chart); });
    }
    made.append(element("div", {class: "controls"}, select("measure", kinds.map(i => data.measures[i].name.replace(/_/g, " ")), 0,
                                                           value => { kind = kinds[value]; update(); })),
                meaning, grid, tableBlock("quality", false));
    update();
  }

  function phases() {
    const key = element("ul", {class: "legend"});
    charts.PHASES.forEach((phase, i) => key.append(element("li", {}, swatch(() => theme.phase(i)), " " + phase)));
    section("phases", "Where the time goes",
      note("Means over confirmed runs, as shares of the time to the end of the search, which stands on the right."), key,
      figuresOfSets("phases"),
      tableBlock("phases", false));
  }

  function anytime() {
    if (sets.every(set => set.anytime_cost.length === 0)) return;
    const grids = element("div");
    const own = names.filter((name, place) => sets.some(set => hasOwnCosts(set, place)));
    const ownCosts = own.length === 0 ? "" :
      ` Costs of another unit are over the lowest that the same contestant found, and do not compare: ${own.join(", ")}.`;
    const part = (title, kind) => grids.append(element("h3", {}, title), figuresOfSets(kind));
    const made = section("anytime", "Getting better with time",
      note("Of planners that go on improving: median and quartiles over the problems of what there is in hand at a time, of each " +
           "problem the median of its trials. A trial whose path the referee did not confirm has nothing in hand; failed attempts " +
           "before a path take their time. Cost: the path's length, over the shortest that anyone here found of the same problem." +
           ownCosts + " Bound: proven, of the cost over the optimum. A curve begins when half of the problems have a path, and " +
           "ends at its contestant's own time limit, or at its last improvement, if that came later: nothing is known of it behind " +
           "that; where the last of all improved, the figure ends. A band reaches the top where a quarter has none."),
      legend(() => grids), grids);
    part("Cost", "cost");
    if (sets.some(set => set.anytime_bound.length > 0)) part("Bound", "bound");
    return made;
  }

  // The problems of failures lead to what happened there.
  function failureCell(row, heading, text) {
    if (heading !== "problems") return [text];
    const {attempts} = data, {columns} = tables.failures;
    const [setName, contestant, status] = ["set", "contestant", "status"].map(name =>
      row[columns.findIndex(column => column.heading === name)]);
    const set = sets.findIndex(one => one.name === setName);
    return text.split(", ").flatMap((one, i) => {
      const problem = parseInt(one, 10);
      const link = element("button", {type: "button", class: "link"}, one);
      link.addEventListener("click", () => {
        showProblem(set, problem);
        const shown = attempts.run.findIndex((run, k) => attempts.set[k] === set && attempts.problem[k] === problem &&
          plainNames[attempts.contestant[k]] === contestant && attempts.statuses[attempts.status[k]] === status &&
          viewData(k));
        if (shown >= 0) showView(shown);
      });
      return i === 0 ? [link] : [", ", link];
    });
  }

  function rest() {
    section("failures", "What failed, and why", tables.failures ? tableBlock("failures", true, failureCell) :
                                                                  note("Every attempt ended with a confirmed path."));
    section("meshes", "Honesty", tables.meshes ? tableBlock("meshes", true) :
                                                                  note(data.without_mesh_robot));
    section("conditions", "Conditions of the measurement", ...data.cautions.map(caution => element("p", {}, caution)),
            tableBlock("conditions", true));
  }

  // ---- Single problems --------------------------------------------------------------------------
  const problem = {set: 0, index: 0, element: element("div")};
  const shown = {element: element("div"), viewer: null};

  // The element that holds the 3D view of an attempt; null if the page has none of it.
  const viewData = attempt => document.getElementById("view-" + attempt);

  function showView(attempt) {
    if (shown.viewer) shown.viewer.dispose();
    const view = JSON.parse(viewData(attempt).textContent);
    for (const id of Object.keys(view.meshes)) view.meshes[id] = JSON.parse(document.getElementById("mesh-" + id).textContent);
    const at = element("div");
    shown.element.replaceChildren(element("h3", {}, view.title), element("p", {}, view.facts.join(" ")), at);
    shown.viewer = makeViewer(at, view);
  }

  function viewButton(attempt) {
    if (!viewData(attempt)) return "";
    const button = element("button", {type: "button"}, "Show in 3D");
    button.addEventListener("click", () => showView(attempt));
    return button;
  }

  function problemsOf(set) {
    const {attempts} = data;
    return [...new Set(attempts.problem.filter((one, i) => attempts.set[i] === set))].sort((a, b) => a - b);
  }

  function problemTable() {
    const {attempts} = data;
    const rows = [];
    const number = value => value == null ? "-" : Number(value.toPrecision(4)).toString();
    attempts.run.forEach((run, i) => {
      if (attempts.set[i] !== problem.set || attempts.problem[i] !== problem.index) return;
      rows.push([nameIn(data, [sets[problem.set]], attempts.contestant[i]), viewButton(i), String(attempts.trial[i]), attempts.directions[attempts.direction[i]],
                 attempts.statuses[attempts.status[i]], number(attempts.time[i]), number(attempts.length[i]),
                 number(attempts.length_simplified[i]), attempts.reasons[attempts.reason[i]], String(run)]);
    });
    const columns = [["contestant"], [""], ["trial", 1], ["direction"], ["status"], ["time, ms", 1], ["length", 1],
                     ["simplified", 1], ["reason"], ["run", 1]];
    return {title: "Attempts at this problem", rows, columns: columns.map(([heading, numeric]) => ({heading, numeric}))};
  }

  function showProblem(set, index) {
    problem.set = set;
    problem.index = index;
    updateProblem();
    document.getElementById("problem").scrollIntoView();
    problem.element.querySelector("select").focus({preventScroll: true});
  }

  function updateProblem() {
    const indices = problemsOf(problem.set);
    const at = Math.max(indices.indexOf(problem.index), 0);
    problem.index = indices[at];
    const step = (label, by) => {
      const button = element("button", {type: "button"}, label);
      button.disabled = !(at + by in indices);
      button.addEventListener("click", () => { problem.index = indices[at + by]; updateProblem(); });
      return button;
    };
    problem.element.replaceChildren(
      element("div", {class: "controls"},
        select("set", sets.map(set => set.name), problem.set, value => { problem.set = value; updateProblem(); }),
        select("problem", indices.map(String), at, value => { problem.index = indices[value]; updateProblem(); }),
        step("Previous", -1), step("Next", 1)),
      tableElement(problemTable()));
  }

  function problems() {
    section("problem", "One problem", note("Every attempt, each direction and trial for itself; run is the id in the table " +
                                           "runs of results.sqlite."), problem.element, shown.element, ...JSON.parse(document.getElementById("view-notes").textContent).map(note));
    updateProblem();
  }

  document.title = "planbench: " + data.sessions.join(", ");
  document.getElementById("subtitle").textContent = data.sessions.join(", ");
  document.getElementById("footer").textContent = `Made by ${data.made_by}. Charts: Vega; 3D: three.js.`;
  answer();
  compared();
  if (names.length > 0) {
    for (const part of [success, times, pairs, quality, phases, anytime, rest, problems]) part();
  }
  return {data};
})();
