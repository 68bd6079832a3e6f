"use strict";
// Tables that sort and filter, commands that can be copied.  A table shows some rows; the others are loaded when asked for.
// A cell is HTML in which all text of the data is escaped.
const Tables = (() => {
  const byId = {};
  // Rows that a table shows at once, and more at each click.
  const STEP = 50;
  const words = new Intl.Collator("en", { numeric: true });

  function make(box) {
    const id = box.dataset.table;
    const table = {
      id, box, body: box.querySelector("tbody"), count: box.querySelector(".count"), more: box.querySelector(".more"),
      all: Number(box.dataset.rows), group: null, words: [], order: null, most: STEP, content: null, asked: 0, done: 0,
    };
    byId[id] = table;
    box.querySelectorAll("thead th").forEach((head, index) => {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", className: "sort", textContent: head.textContent });
      button.addEventListener("click", () => act(table, () => sort(table, head, index)));
      head.replaceChildren(button);
      head.setAttribute("aria-sort", "none");
    });
    box.querySelector(".filter").addEventListener("input", (event) => {
      table.words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
      act(table, () => { table.most = STEP; });
    });
    table.more.addEventListener("click", () => act(table, () => { table.most += STEP; }));
    box.closest("details")?.addEventListener("toggle", (event) => { if (event.target.open) act(table); });
    mark(table);
    count(table, Math.min(table.all, table.body.rows.length), table.all);
  }

  // Change what is shown as soon as the rows are there.
  async function act(table, change = () => {}) {
    const asked = ++table.asked;
    try {
      table.content ??= await Rows.read(table.id);
      change();
      if (asked === table.asked) show(table);
    } catch (error) {
      Rows.complain(table.box, error);
    }
    table.done = Math.max(table.done, asked);
  }

  const ENTITIES = { "&lt;": "<", "&gt;": ">", "&#39;": "'", "&#34;": '"', "&amp;": "&" };
  const plain = (cell) => cell.replace(/<[^>]*>/g, "").replace(/&(lt|gt|#39|#34|amp);/g, (entity) => ENTITIES[entity]);

  function sort(table, head, index) {
    const rising = head.getAttribute("aria-sort") !== "ascending";
    for (const other of head.parentNode.children) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", rising ? "ascending" : "descending");
    const keyed = table.content.cells.map((cells, row) => {
      const [text, stored] = [plain(cells[index]), cells[index].match(/^<data[^>]* value="([^"]*)"/)?.[1]];
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
      return sign * words.compare(a.text, b.text);
    });
    table.order = keyed.map(({ row }) => row);
    table.most = STEP;
  }

  // The places of the rows that the filter and the choice leave, in their order.
  function left(table) {
    const { cells, groups } = table.content;
    return (table.order ?? cells.map((_, row) => row)).filter((row) => {
      if (table.group !== null && groups[row] !== table.group) return false;
      if (!table.words.length) return true;
      const text = cells[row].map(plain).join(" ").toLowerCase();
      return table.words.every((word) => text.includes(word));
    });
  }

  function show(table) {
    const rows = left(table);
    const shown = rows.slice(0, table.most);
    table.body.innerHTML = shown.map((row) => `<tr><td>${table.content.cells[row].join("</td><td>")}</td></tr>`).join("");
    mark(table);
    count(table, shown.length, rows.length);
  }

  function mark(table) {
    for (const number of table.body.querySelectorAll("td > data:not(.rank)")) number.title = number.value;
    table.box.querySelectorAll("thead th").forEach((head, index) => {
      const isNumber = Array.from(table.body.rows).some((row) => row.cells[index].querySelector(":scope > data:not(.rank)"));
      head.classList.toggle("number", isNumber);
    });
  }

  function count(table, shown, chosen) {
    const rows = chosen === table.all ? `${table.all} rows` : `${chosen} of ${table.all} rows`;
    table.count.textContent = shown === chosen ? rows : `${rows}, ${shown} shown`;
    table.more.hidden = shown >= chosen;
  }

  // Show only the rows that belong to a choice of a plot; null for all.
  function choose(id, group) {
    const table = byId[id];
    if (!table || table.group === group) return;
    table.group = group;
    table.most = STEP;
    if (!table.box.closest("details")?.matches(":not([open])")) act(table);
  }

  // The rows that the filter and the choice leave, in their order, and the content of the table.
  async function chosen(id) {
    const table = byId[id];
    table.content ??= await Rows.read(id);
    return { rows: left(table), content: table.content };
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
  // Whether every table shows what was asked for, for tests.
  const settled = () => Object.values(byId).every((table) => table.asked === table.done);
  return { choose, chosen, settled };
})();
