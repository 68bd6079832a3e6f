"use strict";
// Files of the rows that a table shows, in the order in which it shows them: CSV with all stored digits, and LaTeX.
const Files = (() => {
  function text(id, kind) {
    const [before, rows, after] = DATA.tables[id][kind];
    const lines = [before, ...Tables.shown(id).map((row) => rows[row]), after];
    return `${lines.join("\n").trimEnd()}\n`;
  }

  function save(id, kind) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text(id, kind)], { type: kind === "csv" ? "text/csv" : "application/x-tex" }));
    link.download = `${id}.${kind}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  document.addEventListener("click", (event) => {
    const button = event.target instanceof Element && event.target.closest("button[data-save]");
    if (button) save(button.closest(".table").dataset.table, button.dataset.save);
  });
  return { text };
})();
