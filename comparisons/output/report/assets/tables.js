"use strict";
// Tables that sort and filter, commands that can be copied.
// Text from the data goes into the page as text (textContent), never as HTML.
const DATA = JSON.parse(document.getElementById("data").textContent);

const Tables = (() => {
  const byId = {};

  function make(box) {
    const id = box.dataset.table;
    const table = {
      id, box, body: box.querySelector("tbody"), count: box.querySelector(".count"), group: null, words: [],
    };
    byId[id] = table;
    box.querySelectorAll("thead th").forEach((head, index) => {
      head.querySelector("button").addEventListener("click", () => sort(table, head, index));
    });
    box.querySelector(".filter").addEventListener("input", (event) => {
      table.words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
      show(table);
    });
    const fold = box.closest("details");
    if (fold) fold.addEventListener("toggle", () => fold.open && layOut(table));
    if (!fold || fold.open) layOut(table);
  }

  // The rows of a long table are in a template, and laid out when they are first seen.
  function layOut(table) {
    if (table.laidOut) return;
    table.laidOut = true;
    const template = table.body.querySelector("template");
    if (template) {
      table.body.append(template.content);
      template.remove();
    }
    Array.from(table.body.rows, (row, place) => { row.dataset.row = place; });
    for (const cell of table.body.querySelectorAll("td.number[data-v]")) cell.title = cell.dataset.v;
    show(table);
  }

  function sort(table, head, index) {
    layOut(table);
    const rising = head.getAttribute("aria-sort") !== "ascending";
    for (const other of head.parentNode.children) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", rising ? "ascending" : "descending");
    const keyed = Array.from(table.body.rows, (row) => {
      const { v } = row.cells[index].dataset;
      const text = row.cells[index].textContent;
      // Texts that are numbers sort as numbers; what is missing comes last either way.
      const number = v === undefined ? (text === "" ? NaN : Number(text)) : Number(v.replace("inf", "Infinity"));
      return { row, number, text };
    });
    const sign = rising ? 1 : -1;
    keyed.sort((a, b) => {
      if ((a.text === "") !== (b.text === "")) return a.text === "" ? 1 : -1;
      const [one, other] = [Number.isNaN(a.number), Number.isNaN(b.number)];
      if (one !== other) return one ? 1 : -1;
      if (!one) return sign * (a.number === b.number ? 0 : a.number < b.number ? -1 : 1);
      return sign * a.text.localeCompare(b.text, "en", { numeric: true });
    });
    table.body.append(...keyed.map((one) => one.row));
  }

  function show(table) {
    let shown = 0;
    for (const row of table.body.rows) {
      const chosen = table.group === null || row.dataset.group === table.group;
      const text = table.words.length ? row.textContent.toLowerCase() : "";
      row.hidden = !(chosen && table.words.every((word) => text.includes(word)));
      shown += !row.hidden;
    }
    if (!table.laidOut) return;
    const all = table.body.rows.length;
    table.count.textContent = shown === all ? `${all} rows` : `${shown} of ${all} rows`;
  }

  // Show only the rows that belong to a choice of a plot; null for all.
  function choose(id, group) {
    const table = byId[id];
    if (!table) return;
    table.group = group;
    show(table);
  }

  // The places of the rows that are shown, in their order.
  function shown(id) {
    const table = byId[id];
    layOut(table);
    return Array.from(table.body.rows).filter((row) => !row.hidden).map((row) => Number(row.dataset.row));
  }

  async function copy(button) {
    const code = button.parentNode.querySelector("code");
    try {
      await navigator.clipboard.writeText(code.textContent);
      button.textContent = "copied";
      setTimeout(() => { button.textContent = "copy"; }, 2000);
    } catch {
      getSelection().selectAllChildren(code);
    }
  }

  document.querySelectorAll(".table").forEach(make);
  document.addEventListener("click", (event) => {
    if (!(event.target instanceof Element)) return;
    const button = event.target.closest("button");
    if (button?.classList.contains("copy")) copy(button);
  });
  return { choose, shown };
})();
