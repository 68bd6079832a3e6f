"use strict";
// Light or dark: as the system has it, or as the reader chooses; paper is always light.
const Theme = (() => {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const button = document.querySelector("#theme");
  const followers = [];
  let printing = false;

  const chosen = () => document.documentElement.dataset.theme;
  const dark = () => !printing && (chosen() ? chosen() === "dark" : system.matches);

  function tell() {
    if (button) button.textContent = dark() ? "light colours" : "dark colours";
    for (const follower of followers) follower(dark());
  }

  // Calls a function with whether the page is dark, now and whenever that changes.
  function follow(follower) {
    followers.push(follower);
    follower(dark());
  }

  button?.addEventListener("click", () => {
    document.documentElement.dataset.theme = dark() ? "light" : "dark";
    tell();
  });
  system.addEventListener("change", tell);
  addEventListener("beforeprint", () => { printing = true; tell(); });
  addEventListener("afterprint", () => { printing = false; tell(); });
  if (button) button.hidden = false;
  tell();
  return { follow, dark };
})();
