"use strict";
// Verdict badges in the header show only the rows of one verdict; pressed again, all.
for (const button of document.querySelectorAll("button[data-verdict]")) {
  button.addEventListener("click", () => {
    const on = button.getAttribute("aria-pressed") !== "true";
    for (const other of document.querySelectorAll("button[data-verdict]"))
      other.setAttribute("aria-pressed", String(on && other === button));
    for (const row of document.querySelectorAll("tr[data-verdict]"))
      row.hidden = on && row.dataset.verdict !== button.dataset.verdict;
  });
}
// Printed pages show the proofs.
addEventListener("beforeprint", () => document.querySelectorAll("details.proof").forEach(d => { d.open = true; }));
// Figures: a line at the nearest abscissa, a dot on every series there, and their values.
for (const svg of document.querySelectorAll("svg[data-plot]")) {
  const plot = JSON.parse(svg.dataset.plot), [left, top, width, height] = plot.frame;
  const canvas = svg.parentElement, readout = canvas.querySelector(".readout");
  const layer = document.createElementNS(svg.namespaceURI, "g");
  const all = plot.series.flatMap((series, index) => series.points.map(point => ({ series, index, point })));
  const stops = [...new Set(all.map(entry => entry.point[0]))].sort((a, b) => a - b);
  let stop = -1;
  svg.append(layer);
  const number = value => {
    const size = Math.abs(value), plain = shown => String(Number(shown.toPrecision(5))).replace("-", "−");
    if (size === 0 || (size < 1e6 && size >= 1e-4)) return plain(value);
    const power = Math.floor(Math.log10(size) / 3) * 3;
    return plain(value / 10 ** power) + "×10" + [...String(power)].map(c => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join("");
  };
  const draw = (name, attributes) => {
    const element = document.createElementNS(svg.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    layer.append(element);
  };
  const hide = () => { layer.replaceChildren(); readout.hidden = true; stop = -1; };
  const show = (x, y) => {
    // The nearest point of each series, if it is near this abscissa.
    const near = plot.series.map(series => series.points.reduce((best, point) =>
      !best || Math.abs(point[0] - x) < Math.abs(best[0] - x) || (point[0] === best[0] && Math.abs(point[1] - y) < Math.abs(best[1] - y)) ? point : best, null));
    const reach = Math.min(...near.filter(Boolean).map(point => Math.abs(point[0] - x)));
    const shown = near.map((point, index) => ({ point, series: plot.series[index] }))
      .filter(entry => entry.point && Math.abs(entry.point[0] - x) <= reach + 0.02 * width);
    if (!shown.length) return hide();
    const first = shown.reduce((a, b) => Math.abs(b.point[0] - x) < Math.abs(a.point[0] - x) ? b : a).point;
    const closest = shown.reduce((a, b) => Math.abs(b.point[1] - y) < Math.abs(a.point[1] - y) ? b : a);
    layer.replaceChildren();
    draw("path", { class: "cross", d: `M${first[0]} ${top}v${height}M${left} ${closest.point[1]}h${width}` });
    for (const { point, series } of shown) draw("circle", { cx: point[0], cy: point[1], r: 4.5, style: `fill:${series.colour};stroke:var(--paper);stroke-width:1.5` });
    const line = (text, colour, bold) => {
      const row = document.createElement("div");
      if (colour) { const dot = document.createElement("i"); dot.style.background = colour; row.append(dot); }
      if (bold) row.className = "near";
      row.append(text);
      return row;
    };
    const abscissa = plot.categories.length ? plot.categories[first[2]] : `${plot.x.label} ${number(first[2])} ${plot.x.unit}`;
    readout.replaceChildren(line(abscissa), ...shown.slice().sort((a, b) => a.point[1] - b.point[1]).map(entry =>
      line(`${entry.series.label ? entry.series.label + ": " : ""}${number(entry.point[3])} ${plot.y.unit}`, getComputedStyle(svg).getPropertyValue((entry.series.colour.match(/--\w+/) || [""])[0]) || entry.series.colour, entry === closest && shown.length > 1)));
    readout.hidden = false;
    const scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
    const onRight = first[0] * scale + readout.offsetWidth + 24 > svg.getBoundingClientRect().width;
    readout.style.left = `${first[0] * scale + (onRight ? -readout.offsetWidth - 14 : 14)}px`;
    readout.style.top = `${Math.max(0, Math.min(closest.point[1] * scale - readout.offsetHeight / 2, svg.getBoundingClientRect().height - readout.offsetHeight))}px`;
  };
  svg.addEventListener("pointermove", event => {
    const box = svg.getBoundingClientRect(), scale = svg.viewBox.baseVal.width / box.width;
    const x = (event.clientX - box.left) * scale, y = (event.clientY - box.top) * scale;
    if (x < left - 8 || x > left + width + 8) hide(); else show(x, y);
  });
  svg.addEventListener("pointerleave", hide);
  svg.addEventListener("blur", hide);
  svg.addEventListener("keydown", event => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step || !stops.length) return;
    event.preventDefault();
    stop = Math.max(0, Math.min(stops.length - 1, stop + step));
    show(stops[stop], top + height / 2);
  });
}
