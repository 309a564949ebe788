"use strict";
const all = (selector, inside = document) => [...inside.querySelectorAll(selector)];
const one = (selector, inside = document) => inside.querySelector(selector);
const make = (name, properties, ...children) => {
  const { style, ...rest } = properties, element = Object.assign(document.createElement(name), rest);
  if (style) element.setAttribute("style", style);
  element.append(...children);
  return element;
};
const raised = power => [...String(power)].map(c => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join("");
const exponent = number => number ? Math.floor(Math.log10(Math.abs(number)) + 1e-9) : 0;
const shown = (number, digits) => {
  const power = exponent(number), plain = value => String(Number(value.toPrecision(digits))).replace("-", "−");
  if (power >= -4 && power < 6) return plain(number);
  const three = Math.floor(power / 3) * 3;
  return plain(number / 10 ** three) + "×10" + raised(three);
};
// The power of ten left out of the labels of an axis.
const tens = axis => {
  const power = exponent(Math.max(Math.abs(axis.low), Math.abs(axis.high)));
  return axis.log || (power >= -2 && power < 5) ? 0 : Math.floor(power / 3) * 3;
};
// Values worth a line, and their labels: 1, 2 or 5 times a power of ten.
const ticks = axis => {
  const { low, high, log } = axis, found = [];
  if (log && high / low >= 3) {
    const first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high)), step = Math.ceil((last - first) / 12);
    for (let power = first; power <= last; power += step) for (const digit of last - first < 4 ? [1, 2, 5] : [1]) {
      const number = digit * 10 ** power;
      if (number >= low && number <= high) found.push([number, power < -2 || power > 4 ? (digit > 1 ? digit + "·10" : "10") + raised(power) : String(Number(number.toPrecision(3)))]);
    }
    if (found.length > 1) return found;
    found.length = 0;
  }
  const wanted = (high - low) / axis.ticks, power = exponent(wanted), digit = [1, 2, 5, 10].find(digit => digit * 10 ** power >= wanted * (1 - 1e-9));
  const step = digit * 10 ** power, left = tens(axis), places = Math.max(0, left - power - (digit > 9 ? 1 : 0));
  for (let count = Math.ceil(low / step - 1e-9); count <= high / step + 1e-9; count += 1)
    found.push([count * step, (count * step / 10 ** left).toFixed(Math.min(places, 20)).replace(/^-(?=.*[1-9])/, "−").replace("-", "")]);
  return found;
};
// Comma-separated values; what a spreadsheet would compute stays text.
const table = rows => rows.map(row => row.map(cell => {
  const text = cell === null || cell === undefined ? "" : typeof cell === "string" && /^[=+\-@\t\r'＝＋－＠]/.test(cell) ? "'" + cell : String(cell);
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}).join(",")).join("\n") + "\n";
const save = (download, text) => {
  const href = URL.createObjectURL(new Blob([text]));
  make("a", { href, download }).click();
  setTimeout(() => URL.revokeObjectURL(href), 1000);
};
// Verdict badges in the header show only the rows of one verdict; pressed again, all.
for (const button of all("button[data-verdict]")) button.addEventListener("click", () => {
  const on = button.getAttribute("aria-pressed") !== "true";
  for (const other of all("button[data-verdict]")) other.setAttribute("aria-pressed", String(on && other === button));
  for (const row of all("tr[data-verdict]")) row.hidden = on && row.dataset.verdict !== button.dataset.verdict;
  for (const inputs of all("details.inputs")) inputs.open = on && one("tr:not([hidden])", one("tbody", inputs)) !== null;
});
// Printed pages show the proofs.
addEventListener("beforeprint", () => all("details.proof").forEach(proof => { proof.open = true; }));
