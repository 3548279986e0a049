// What every page does: it says when the service cannot be reached, and that it can be reached again.
"use strict";
window.galloping = {
  lost() {
    const notice = document.getElementById("connection");
    notice.textContent = notice.dataset.lost;
    notice.hidden = false;
  },
  found() {
    document.getElementById("connection").hidden = true;
  },
};
document.addEventListener("htmx:sendError", window.galloping.lost);
document.addEventListener("htmx:timeout", window.galloping.lost);
document.addEventListener("htmx:afterOnLoad", window.galloping.found);
window.addEventListener("offline", window.galloping.lost);
window.addEventListener("online", window.galloping.found);
