"use strict";
// Files of the rows that a table shows, in the order in which it shows them: CSV with all stored digits, and LaTeX.
const Files = (() => {
  const { number, tokens, characters } = DATA.latex;
  const NUMBER = new RegExp(`^${number}$`);
  const TOKENS = new RegExp(tokens, "g");
  const GREEK = new Set(["mu", "nu", "kappa"]);

  const short = (text) => text.replace(/e(-?)\+?0*([0-9])/, "e$1$2");
  const math = (token) => (GREEK.has(token) ? `$\\${token}$` : /^[a-z]+$/.test(token) ? `$${token}$` : `\\num{${short(token)}}`);
  const plain = (text) => text.split("--").map((part) => Array.from(part, (one) => characters[one] ?? one).join("")).join("-{}-");

  // The same as comparisons.output.latex_text.escaped.
  function escaped(text) {
    const line = text.split(/[\s\x1c-\x1f\x85]+/).filter(Boolean).join(" ").normalize("NFC");
    const parts = [];
    let end = 0;
    for (const token of line.matchAll(TOKENS)) {
      parts.push(plain(line.slice(end, token.index)), math(token[0]));
      end = token.index + token[0].length;
    }
    return [...parts, plain(line.slice(end))].join("");
  }

  function cell(text, kind) {
    if (kind === "number") return text === "" || NUMBER.test(text) ? short(text) : `{${escaped(text)}}`;
    if (kind === "text") return escaped(text);
    return escaped(text).replaceAll("\\_", "\\_\\allowbreak{}").replaceAll("/", "/\\allowbreak{}");
  }

  function latex({ rows, latex: { columns, kinds, floating, long, most } }, shown) {
    const [before, after] = shown.length <= most ? floating : long;
    const first = (one) => (Array.isArray(one) ? one[0] : one);
    const lines = shown.map((row) => `${columns.map((column, place) => cell(first(rows[row][1][column]), kinds[place])).join(" & ")} \\\\`);
    if (!lines.length) lines.push(`\\multicolumn{${kinds.length}}{l}{none} \\\\`);
    return [before, ...lines, after, ""].join("\n");
  }

  function csv({ source, lines }, shown) {
    const [head, ...records] = DATA.files[source];
    const places = shown.flatMap((row) => (lines ? lines[row] : row));
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
