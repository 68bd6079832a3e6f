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
      rows: Array.from(box.querySelectorAll("tbody tr")), groups: DATA.tables[id].groups,
    };
    byId[id] = table;
    table.rows.forEach((row, index) => { row.dataset.row = index; });
    for (const data of box.querySelectorAll("td > data:not(.rank)")) data.title = data.value;
    box.querySelectorAll("thead th").forEach((head, index) => {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", className: "sort", textContent: head.textContent });
      button.addEventListener("click", () => sort(table, head, index));
      head.replaceChildren(button);
      head.setAttribute("aria-sort", "none");
      head.classList.toggle("number", table.rows.some((row) => row.cells[index].querySelector(":scope > data:not(.rank)")));
    });
    box.querySelector(".filter").addEventListener("input", (event) => {
      table.words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
      show(table);
    });
    show(table);
  }

  function sort(table, head, index) {
    const rising = head.getAttribute("aria-sort") !== "ascending";
    for (const other of head.parentNode.children) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", rising ? "ascending" : "descending");
    const keyed = table.rows.map((row) => {
      const text = row.cells[index].textContent;
      const stored = row.cells[index].querySelector("data")?.value;
      // Texts that are numbers sort as numbers; what is missing comes last either way.
      const number = stored === undefined ? (text === "" ? NaN : Number(text)) : Number(stored.replace("inf", "Infinity"));
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
    for (const row of table.rows) {
      const chosen = table.group === null || table.groups[row.dataset.row] === table.group;
      const text = table.words.length ? row.textContent.toLowerCase() : "";
      row.hidden = !(chosen && table.words.every((word) => text.includes(word)));
      shown += !row.hidden;
    }
    const all = table.rows.length;
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
    return Array.from(byId[id].body.rows).filter((row) => !row.hidden).map((row) => Number(row.dataset.row));
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
