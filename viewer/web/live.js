"use strict";
// The page of the program viewer: shows the events that it is sent (viewer/live_server.h).
const live = (() => {
  const at = id => document.getElementById(id);
  const element = (tag, attributes, ...children) => {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.append(...children);
    return made;
  };

  function table(title, headings, rows) {
    if (rows.length === 0) return element("p", {class: "note"}, "None.");
    return element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": title}, element("table", {},
      element("thead", {}, element("tr", {}, ...headings.map(text => element("th", {scope: "col"}, text)))),
      element("tbody", {}, ...rows.map(row => element("tr", {}, ...row.map(text => element("td", {}, text)))))));
  }

  const seconds = value => (value == null ? "-" : Number((1000 * value).toPrecision(3)).toLocaleString("en") + " ms");

  function showState(state) {
    const runs = state.contestants.reduce((sum, one) => sum + one.runs, 0);
    const session = state.session;
    at("subtitle").textContent = !session ?
      (runs === 0 ? "no session heard yet" : `${runs} runs heard of a session that began before this viewer listened`) :
      `session ${session.run_id}, robot ${session.robot}: ` +
      (session.finished ? `finished, ${session.num_runs} runs` : `${runs} runs heard of ${session.num_runs}`);
    at("nodes").replaceChildren(table("Nodes", ["name", "kind", "state", "host"], state.nodes.map(node => [
      node.name, node.kind, node.gone ? "gone" : node.busy ? `busy with ${node.request}` : "ready", node.host])));
    at("contestants").replaceChildren(table("Contestants", ["contestant", "runs", "solved"], state.contestants.map(one => [
      one.name, String(one.runs), String(one.solved)])));
    at("runs").replaceChildren(table("Last runs", ["contestant", "problem", "status", "time", "reason"], state.runs.map(run => [
      run.contestant, run.problem, run.status, seconds(run.time_s), run.reason])));
    at("progress").replaceChildren(table("Improvements", ["time", "cost", "bound"], state.progress.map(one => [
      seconds(one.time_s), one.cost == null ? "-" : String(Number(one.cost.toPrecision(5))),
      one.bound == null ? "-" : String(Number(one.bound.toPrecision(4)))])));
    at("bus").textContent = `${state.lost} messages lost, ${state.dropped} dropped here, ` +
      `${state.malformed} packets and ${state.undecodable} messages that could not be used.`;
  }

  // A request may take milliseconds: the newest is shown, as long as an eye needs.
  const SHOWN_MS = 1500;
  let viewer = null, next = null, shownAt = -Infinity;
  function showNext() {
    if (next === null || !at("follow").checked || performance.now() - shownAt < SHOWN_MS) return;
    const data = next;
    next = null;
    shownAt = performance.now();
    at("view-title").textContent = data.title || "No view";
    at("facts").textContent = data.message || data.facts.join(" ");
    at("view").hidden = Boolean(data.message);  // what it showed is another request
    if (data.message) return;
    const made = makeViewer(at("view"), data, viewer);
    viewer = made;
    if (data.motions.length > 0) viewer.play();
  }
  setInterval(showNext, 200);

  const source = new EventSource("/events");
  source.addEventListener("state", event => showState(JSON.parse(event.data)));
  let meshes = {};  // that the view sent last named, its own and others to come again
  source.addEventListener("view", event => {
    next = JSON.parse(event.data);
    if (next.meshes) {
      for (const id of Object.keys(next.meshes)) next.meshes[id] = next.meshes[id] || meshes[id];
      meshes = next.meshes;
    }
    showNext();
  });
  source.addEventListener("error", () => { at("subtitle").textContent = "the viewer does not answer; trying again"; });
  return {viewer: () => viewer};
})();
