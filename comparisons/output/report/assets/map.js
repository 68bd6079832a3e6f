"use strict";
// Maps of regimes: a click on an option shows the map of that choice.
const Maps = (() => {
  async function make(box) {
    const views = JSON.parse(await Rows.inflated(box.querySelector("script").textContent));
    const keys = views.map(([options]) => options);
    const groups = Array.from(box.querySelectorAll("fieldset"));
    let chosen = groups.map((group) => group.querySelector(":checked").value);

    // The map with this option that has most of the other options in common with the one before.
    function choose(index, option) {
      const common = (key) => key.reduce((sum, text, other) => sum + (text === chosen[other]), 0);
      const possible = keys.filter((key) => key[index] === option);
      chosen = possible.reduce((best, key) => (common(key) > common(best) ? key : best));
      show();
    }

    function show() {
      box.querySelector(".scroll").innerHTML = views.find(([options]) => options.every((text, index) => text === chosen[index]))[1];
      groups.forEach((group, index) => {
        // Options that the choices before leave.
        const left = new Set(keys.filter((key) => key.slice(0, index).every((text, other) => text === chosen[other])).map((key) => key[index]));
        group.hidden = left.size < 2;
        for (const input of group.querySelectorAll("input")) {
          input.checked = input.value === chosen[index];
          input.closest("label").hidden = !left.has(input.value);
        }
      });
    }

    groups.forEach((group, index) => group.addEventListener("change", (event) => choose(index, event.target.value)));
    show();
  }
  return { ready: Promise.all(Array.from(document.querySelectorAll(".regimes"), make)) };
})();
