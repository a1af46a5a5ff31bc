"use strict";
// What pages do beyond plain forms. Everything works without it.
document.addEventListener("htmx:after:swap", () => {
  const invalid = document.querySelector(".verdict.asked");
  if (invalid) { invalid.closest("form")?.querySelector("input[type=text], textarea")?.focus(); }
});
