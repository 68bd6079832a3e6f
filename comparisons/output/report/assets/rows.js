"use strict";
// What a page opens later: rows of tables, points of plots and the library that draws them, in a file beside the page.
const DATA = JSON.parse(document.getElementById("data").textContent);

const Rows = (() => {
  let arriving;

  // The file, loaded once; it calls this function with its name and its texts.
  function load() {
    arriving ??= new Promise((resolve, reject) => {
      const missing = () => reject(new Error(`the rows of this page are in ${DATA.file}, which has to be beside it`));
      window.fscmBenchRows = (digest, texts) => (digest === DATA.digest ? resolve(texts) : missing());
      run({ src: DATA.file, onerror: missing });
    });
    return arriving;
  }

  function run(properties) {
    document.head.append(Object.assign(document.createElement("script"), { nonce: DATA.nonce }, properties));
  }

  // The text behind a compressed one.
  function inflated(text) {
    const binary = atob(text);
    const bytes = new Uint8Array(binary.length);
    for (let index = 0; index < binary.length; index++) bytes[index] = binary.charCodeAt(index);
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
  }

  const text = async (name) => inflated((await load())[name]);
  const read = async (name) => JSON.parse(await text(name));

  // Tells the reader in the place where something should have appeared.
  function complain(place, error) {
    const note = place.querySelector(":scope > .missing") ?? document.createElement("p");
    Object.assign(note, { className: "missing note", textContent: error.message });
    place.prepend(note);
  }
  return { read, text, run, inflated, complain };
})();
