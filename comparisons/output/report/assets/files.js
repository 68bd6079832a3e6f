"use strict";
// Files of the rows that a filter and a choice leave, in the order of the table: CSV with all stored digits, and LaTeX.
const Files = (() => {
  async function text(id, kind) {
    const { rows, content } = await Tables.chosen(id);
    const [before, lines, after] = content[kind];
    return `${[before, ...rows.map((row) => lines[row]), after].join("\n").trimEnd()}\n`;
  }

  async function save(id, kind) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([await text(id, kind)], { type: kind === "csv" ? "text/csv" : "application/x-tex" }));
    link.download = `${id}.${kind}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  document.addEventListener("click", (event) => {
    const button = event.target instanceof Element && event.target.closest("button[data-save]");
    if (!button) return;
    const box = button.closest(".table");
    save(box.dataset.table, button.dataset.save).catch((error) => Rows.complain(box, error));
  });
  return { text };
})();
