// The keyboard reaches what scrolls by itself: wide tables, formulas and code.
for (const box of document.querySelectorAll("pre, .table-wrapper, div.math")) {
  if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
}
