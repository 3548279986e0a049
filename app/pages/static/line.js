// Reads a file that the reader chose into the text beside it (the form then sends the text), and keeps drawings of old rows away.
"use strict";
for (const chooser of document.querySelectorAll("input[type=file][data-into]")) {
  chooser.addEventListener("change", async () => {
    const [file] = chooser.files;
    if (file) document.getElementById(chooser.dataset.into).value = await file.text();
  });
}
// A drawing that was asked for before rows changed has their old numbers, and one that comes while they change may speak of
// fields that are not there yet: neither is shown, and the next one follows the rows.
let rowsChanged = 0;
let rowsUnderWay = 0;
const isOfRows = (event) => event.detail.target.id.startsWith("group-");
document.addEventListener("htmx:beforeRequest", (event) => {
  event.detail.xhr.rowsChanged = rowsChanged;
  if (isOfRows(event)) rowsUnderWay += 1;
});
document.addEventListener("htmx:afterRequest", (event) => {
  if (isOfRows(event)) rowsUnderWay -= 1;
});
document.addEventListener("htmx:beforeSwap", (event) => {
  if (isOfRows(event)) rowsChanged += 1;
  else if (event.detail.target.id !== "preview") return;
  else if (rowsUnderWay || event.detail.xhr.rowsChanged !== rowsChanged) event.detail.shouldSwap = false;
});
// Says aloud how many places are at fault, only when that changes.
document.addEventListener("htmx:afterSwap", (event) => {
  if (event.detail.target.id !== "preview") return;
  const status = document.getElementById("preview-said");
  const said = (event.detail.target.querySelector("[data-said]") || status).dataset.said;
  if (status.textContent !== said) status.textContent = said;
});
