// SPDX-License-Identifier: GPL-3.0-or-later
// Sets the formulas of a page; their texts are \(...\) within lines and \[...\] on lines of their own.
document.addEventListener("DOMContentLoaded", () => {
  for (const formula of document.querySelectorAll(".arithmatex")) {
    const text = formula.textContent.trim();
    katex.render(text.slice(2, -2), formula, { displayMode: text.startsWith("\\["), throwOnError: false });
  }
});
