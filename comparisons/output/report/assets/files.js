"use strict";
// Files of the rows that a table shows, in the order in which it shows them: CSV with all stored digits, and LaTeX.
const Files = (() => {
  function latex({ latex: [before, rows, after] }, shown) {
    return [before, ...shown.map((row) => rows[row]), after, ""].join("\n");
  }

  function csv({ source, lines }, shown) {
    const [head, ...records] = DATA.files[source];
    const places = shown.flatMap((row) => lines[row]);
    return [head, ...places.map((place) => records[place]), ""].join("\n");
  }

  const text = (id, kind) => ({ csv, tex: latex })[kind](DATA.tables[id], Tables.shown(id));

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
