// Shows the equations of a page with KaTeX, which draws without a network.
document.addEventListener("DOMContentLoaded", () =>
  document.querySelectorAll(".math").forEach((element) =>
    renderMathInElement(element, {
      delimiters: [
        { left: "\\(", right: "\\)", display: false },
        { left: "\\[", right: "\\]", display: true },
      ],
    }),
  ),
);
