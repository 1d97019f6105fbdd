// Numbers in words, colours and tables, as every report page shows them.
const softland = (() => {
  "use strict";
  const prefixes = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"], [1e-15, "f"]];
  const noBreak = "\u00a0";
  const prefix = (largest) => (largest > 0 ? prefixes.find(([factor]) => largest >= factor * (1 - 1e-9)) || prefixes[prefixes.length - 1] : [1, ""]);
  const minus = (text) => String(text).replace("-", "\u2212");
  // Formats a number as reports/quantity.h does; a value below `least`, the resolution of the unit, is 0.
  const quantity = (value, unit, least, digits = 4) => {
    if (value == null || !isFinite(value)) return "";
    if (!unit) return minus(+value.toPrecision(digits));
    if (Math.abs(value) < (least || Number.MIN_VALUE)) return "0" + noBreak + unit;
    const [factor, symbol] = prefix(Math.abs(+value.toPrecision(digits)));
    const whole = Math.floor(Math.log10(Math.abs(value / factor)) + 1e-9) + 1;
    const decimals = Math.min(digits - whole, least ? Math.round(Math.log10(factor / least)) : digits);
    return minus((value / factor).toFixed(Math.max(0, decimals))) + noBreak + symbol + unit;
  };
  const superscript = (exponent) => "10" + String(exponent).replace(/./g, (c) => "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"["-0123456789".indexOf(c)]);
  // Formats a number at an axis; whole powers of ten beyond four digits are written as powers.
  const tickText = (value) => {
    const exponent = Math.log10(Math.abs(value));
    if (value > 0 && Math.abs(exponent) > 3.5 && Math.abs(exponent - Math.round(exponent)) < 1e-9) return superscript(Math.round(exponent));
    return minus(+value.toPrecision(6));
  };
  // Returns the values of a column, which holds integer steps of a unit or plain values.
  const column = ({unit, steps, values}) => {
    if (values) return values;
    let sum = 0;
    return steps.map((step) => (step === null ? null : (sum += step) * unit));
  };
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  const font = (size) => size + 'px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';
  // Prepares wide tables for narrow screens, where every row is a card whose numbers have the headings of their columns.
  const makeCards = () => {
    for (const table of document.querySelectorAll("table")) {
      const headings = [...table.querySelectorAll("thead th")].map((one) => one.textContent);
      if (headings.length < 3) continue;
      table.classList.add("wide");
      for (const row of table.tBodies[0].rows) [...row.cells].forEach((cell, i) => (cell.dataset.label = headings[i]));
    }
  };
  return {noBreak, prefix, minus, quantity, tickText, column, colour, font, makeCards};
})();
