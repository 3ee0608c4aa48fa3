"use strict";
// The page of the program view: one 3D view and its facts.
const view = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  document.title = "planbench: " + data.title;
  document.getElementById("title").textContent = data.title;
  document.getElementById("subtitle").textContent = data.facts.join(" ");
  return makeViewer(document.getElementById("main"), data);
})();
