// A figure: readout at the nearest abscissa, series shown and hidden, a box to zoom into with axes of its own, CSV, SVG.
for (const figure of all("figure")) {
  const svg = one("svg[data-plot]", figure);
  if (!svg) continue;
  const plot = JSON.parse(svg.dataset.plot), [left, top, width, height] = plot.frame;
  const canvas = svg.parentElement, readout = one(".readout", canvas), axes = one(".axes", svg), data = one(".data", svg);
  const tag = (name, attributes, text) => {
    const element = document.createElementNS(svg.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    return element;
  };
  const layer = svg.appendChild(tag("g", {})), box = svg.appendChild(tag("rect", { class: "lasso" }));
  const uncut = data.getAttribute("viewBox");
  const drawn = all("path", data).map(path => [path, path.getAttribute("d")]);
  const named = all("text", data).map(text => [text, +text.getAttribute("x"), +text.getAttribute("y")]);
  const names = all(".name", axes), labels = all(".label", axes), flat = plot.cells && plot.cells.y.length < 2;
  let view = plot, stop = -1, at = null;
  const share = (axis, value) => axis.log ? Math.log(value / axis.low) / Math.log(axis.high / axis.low)
    : (value - axis.low) / (axis.high - axis.low);
  const value = (axis, share) => axis.log ? axis.low * (axis.high / axis.low) ** share : axis.low + share * (axis.high - axis.low);
  const upright = share => plot.down ? share : 1 - share;
  const toX = (number, { x } = view) => left + width * share(x, number);
  const toY = (number, { y } = view) => top + height * upright(share(y, number));
  // Points have six digits, and are drawn to a hundredth of a px of the whole: a thousandth of it has no more to show.
  const part = (axis, all) => share(all, axis.high) - share(all, axis.low);
  const fits = (axis, all, now) => part(axis, all) >= Math.min(part(now, all), 1e-3);
  const place = (element, lengths) => ["x", "y", "width", "height"].forEach((key, index) => element.setAttribute(key, lengths[index]));
  const scale = () => svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
  const redraw = () => {
    const [x0, x1] = [toX(view.x.low, plot), toX(view.x.high, plot)];
    const ends = [toY(view.y.low, plot), toY(view.y.high, plot)], [y0, y1] = [Math.min(...ends), Math.max(...ends)];
    const [k, m] = [width / (x1 - x0), height / (y1 - y0)];
    const x = px => (left + (px - x0) * k).toFixed(2), y = py => (top + (py - y0) * m).toFixed(2);
    for (const [path, d] of drawn) path.setAttribute("d", d.replace(/([MLHV])(-?[\d.]+)(?: (-?[\d.]+))?/g, (_, letter, p, q) =>
      letter === "V" ? "V" + y(p) : letter === "H" ? "H" + x(p) : `${letter}${x(p)} ${y(q)}`));
    for (const [text, px, py] of named) { text.setAttribute("x", x(px)); text.setAttribute("y", y(py)); }
    // The whole has room for lines on its edge; of a part nothing runs over the axes.
    const cut = view === plot ? uncut : plot.frame.join(" ");
    data.setAttribute("viewBox", cut);
    place(data, cut.split(" "));
    axes.replaceChildren();
    const bottom = top + height, right = left + width;
    const line = (name, d) => axes.append(tag("path", { class: name, d }));
    const tick = (label, x, y, anchor) => axes.append(tag("text", { class: "tick", x, y, "text-anchor": anchor }, label));
    for (const [number, label] of flat ? [] : ticks(view.y)) {
      line(plot.ratio && number === 0 ? "axis" : "grid", `M${left} ${toY(number)}H${right}`);
      tick(label, left - 8, toY(number) + 4.5, "end");
    }
    for (const [number, label] of plot.names.length ? [] : ticks(view.x)) {
      line("grid", `M${toX(number)} ${top}V${bottom}`);
      line("axis", `M${toX(number)} ${bottom}v5`);
      tick(label, toX(number), bottom + 20, "middle");
    }
    line("axis", `M${left} ${top}V${bottom}H${right}`);
    const said = ({ label, unit }, power) => {
      const parts = [power ? "10" + raised(power) : "", unit].filter(Boolean).join(" ");
      return parts ? `${label} (${parts})` : label;
    };
    labels[0].textContent = said(view.x, plot.names.length ? 0 : tens(view.x));
    labels[1].textContent = flat ? view.y.label
      : said(view.y, tens(view.y)) + (plot.ratio ? `, ${shown(plot.ratio * m / k, 3)} : 1` : "");
    axes.append(...names, ...labels);
    hide();
  };
  const zoom = (x, y) => {
    if (plot.names.length) x = [view.x.low, view.x.high];
    const next = { x: { ...view.x, low: x[0], high: x[1] }, y: { ...view.y, low: y[0], high: y[1] } };
    if (fits(next.x, plot.x, view.x) && fits(next.y, plot.y, view.y)) { view = next; redraw(); }
  };
  // By a factor, about what is read or the middle.
  const enlarge = factor => {
    const about = (axis, centre) => [-0.5, 0.5].map(side => value(axis, centre + side * factor));
    const inside = at && [share(view.x, at[0]), share(view.y, at[1])];
    zoom(about(view.x, inside ? inside[0] : 0.5), about(view.y, inside ? inside[1] : 0.5));
  };
  const reset = () => { view = plot; redraw(); };
  const hide = () => { layer.replaceChildren(); readout.replaceChildren(); stop = -1; at = null; };
  const series = () => plot.series.filter((_, index) => { const g = one(`[data-s=s${index}]`, data); return g && !g.style.display; });
  const inside = point => [toX(point[0]), toY(point[1])].every((px, axis) =>
    px > (axis ? top : left) - 4 && px < (axis ? top + height : left + width) + 4);
  const row = (text, colour, bold) => {
    const dot = colour ? [make("i", { style: `background:${getComputedStyle(svg).getPropertyValue((colour.match(/--\w+/) || [""])[0]) || colour}` })] : [];
    return make("div", { className: bold ? "near" : "" }, ...dot, text);
  };
  const tell = (px, py, rows) => {
    readout.replaceChildren(...rows);
    const size = svg.getBoundingClientRect(), offset = size.left - canvas.getBoundingClientRect().left + canvas.scrollLeft;
    const x = px * scale(), y = py * scale(), onRight = x + readout.offsetWidth + 24 > size.width;
    readout.style.left = `${Math.max(0, offset + x + (onRight ? -readout.offsetWidth - 14 : 14))}px`;
    readout.style.top = `${Math.max(0, Math.min(y - readout.offsetHeight / 2, size.height - readout.offsetHeight))}px`;
  };
  const cross = (px, py) => layer.append(tag("path", { class: "cross", d: `M${px} ${top}v${height}M${left} ${py}h${width}` }));
  const named_value = (axis, number) => `${axis.label} ${shown(number, 5)} ${axis.unit}`.trim();
  const readCell = (x, y) => {
    const { cells } = plot, nearest = (values, px, to) => values.reduce((best, number, index) =>
      Math.abs(to(number) - px) < Math.abs(to(values[best]) - px) ? index : best, 0);
    const i = nearest(cells.x, x, toX), j = nearest(cells.y, y, toY), number = cells.values[j * cells.x.length + i];
    at = [cells.x[i], cells.y[j]];
    layer.replaceChildren();
    cross(toX(at[0]), toY(at[1]));
    tell(toX(at[0]), toY(at[1]), [row(named_value(plot.x, at[0])), ...flat ? [] : [row(named_value(plot.y, at[1]))],
      row(`${cells.label} ${number === null ? "–" : shown(number, 5)} ${cells.unit}`, "", true)]);
  };
  // At a point of the curves, the one nearest to the pointer; without a height at the abscissa alone.
  const read = (x, y) => {
    if (plot.cells) return readCell(x, y);
    const far = point => Math.abs(toX(point[0]) - x), off = point => Math.abs(toY(point[1]) - y);
    const near = series().map(series => ({ series, point: series.points.filter(inside).reduce((best, point) =>
      !best || far(point) < far(best) || (point[0] === best[0] && off(point) < off(best)) ? point : best, null) })).filter(entry => entry.point);
    const reach = Math.min(...near.map(entry => far(entry.point))), found = near.filter(entry => far(entry.point) <= reach + 0.02 * width);
    if (!found.length) return hide();
    const apart = y === undefined ? far : off, closest = found.reduce((a, b) => apart(b.point) < apart(a.point) ? b : a);
    at = closest.point;
    const [px, py] = [toX(at[0]), toY(at[1])], told = point => shown(point[0], 5);
    layer.replaceChildren();
    cross(px, py);
    for (const { point, series } of found) layer.append(tag("circle", { cx: toX(point[0]), cy: toY(point[1]), r: 4.5, style: `fill:${series.colour};stroke:var(--paper);stroke-width:1.5` }));
    const name = plot.names[at[0]] || named_value(plot.x, at[0]) + (Math.abs(px - x) > 1 ? ", nearest point" : "");
    const said = ({ point, series: { label } }) => `${label ? label + ": " : ""}${shown(point[1], 5)} ${plot.y.unit}`
      + (told(point) === told(at) ? "" : ` at ${told(point)} ${plot.x.unit}`);
    // No more rows than there is room for: those that are nearest.
    const upwards = ({ point }) => toY(point[1]), most = Math.min(10, canvas.clientHeight / 18 - 3);
    const left_out = found.sort((a, b) => Math.abs(upwards(a) - py) - Math.abs(upwards(b) - py)).splice(most).length;
    tell(px, py, [row(name), ...found.sort((a, b) => upwards(a) - upwards(b)).map(entry =>
      row(said(entry), entry.series.colour, entry === closest && found.length > 1)), ...left_out ? [row(left_out + " more")] : []]);
  };
  const where = event => {
    const size = svg.getBoundingClientRect();
    return [(event.clientX - size.left) / scale(), (event.clientY - size.top) / scale()];
  };
  let from = null;
  const corners = to => [[from[0], to[0]], [from[1], to[1]]].map((pair, axis) => {
    const [low, high] = axis ? [top, top + height] : [left, left + width];
    return pair.map(px => Math.max(low, Math.min(high, px))).sort((a, b) => a - b);
  });
  svg.addEventListener("pointerdown", event => {
    if (event.pointerType === "touch" || event.button) return;
    from = where(event);
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointermove", event => {
    const [x, y] = where(event);
    if (from) {
      const [[x0, x1], [y0, y1]] = corners([x, y]);
      place(box, [x0, y0, x1 - x0, y1 - y0]);
    } else if (x < left - 8 || x > left + width + 8) hide(); else read(x, y);
  });
  svg.addEventListener("pointerup", event => {
    if (!from) return;
    let [[x0, x1], [y0, y1]] = corners(where(event));
    from = null;
    box.removeAttribute("width");
    if (x1 - x0 < 8 || y1 - y0 < 8) return;
    // A drawing stays true to scale.
    const grow = plot.equal ? Math.max((x1 - x0) / width, (y1 - y0) / height) : 0;
    const wide = (low, high, all) => grow ? [(low + high - grow * all) / 2, (low + high + grow * all) / 2] : [low, high];
    [[x0, x1], [y0, y1]] = [wide(x0, x1, width), wide(y0, y1, height)];
    const ys = [y0, y1].map(py => value(view.y, upright((py - top) / height))).sort((a, b) => a - b);
    zoom([x0, x1].map(px => value(view.x, (px - left) / width)), ys);
  });
  svg.addEventListener("dblclick", reset);
  svg.addEventListener("pointerleave", hide);
  canvas.addEventListener("blur", hide);
  canvas.addEventListener("keydown", event => {
    const actions = { "+": () => enlarge(0.5), "-": () => enlarge(2), "0": reset, Escape: hide };
    const step = { ArrowRight: 1, ArrowLeft: -1, Home: -Infinity, End: Infinity }[event.key];
    if (actions[event.key]) { event.preventDefault(); actions[event.key](); }
    if (!step) return;
    event.preventDefault();
    const points = plot.cells ? plot.cells.x.map(x => [x, plot.cells.y[plot.cells.y.length >> 1]]) : series().flatMap(series => series.points);
    const stops = [...new Set(points.filter(inside).map(point => point[0]))].sort((a, b) => a - b);
    if (!stops.length) return hide();
    const next = Math.max(0, Math.min(stops.length - 1, stop + step));
    read(toX(stops[next]), plot.cells ? top + height / 2 : undefined);
    stop = next;
    canvas.scrollLeft = toX(stops[next]) * scale() - canvas.clientWidth / 2;
  });
  for (const button of all(".legend button", figure)) button.addEventListener("click", () => {
    const on = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(on));
    for (const group of all(`[data-s=${button.dataset.s}]`, data)) group.style.display = on ? "" : "none";
    hide();
  });
  const name = figure.id.slice(7), unit = axis => axis.unit ? `${axis.label} [${axis.unit}]` : axis.label;
  const csv = () => {
    const { cells } = plot;
    if (cells) return table([[unit(plot.x), unit(plot.y), unit(cells)], ...cells.values.map((number, index) =>
      [cells.x[index % cells.x.length], cells.y[Math.floor(index / cells.x.length)], number])]);
    return table([["series", unit(plot.x), unit(plot.y)], ...plot.series.flatMap(series =>
      series.points.map(([x, y]) => [series.label, plot.names.length ? plot.names[x] : x, y]))]);
  };
  const drawing = () => {
    const copy = svg.cloneNode(true), size = svg.viewBox.baseVal, items = all(".legend button[aria-pressed=true]", figure);
    for (const extra of [copy.lastChild, copy.lastChild.previousSibling]) extra.remove();
    copy.removeAttribute("data-plot");
    for (const group of all("[data-s]", copy)) if (group.style.display) group.remove();
    let x = left, rows = items.length ? 1 : 0;
    const legend = items.map(item => {
      const long = 48 + 7 * item.textContent.length;
      if (x > left && x + long > size.width) { x = left; rows += 1; }
      const g = tag("g", { transform: `translate(${x} ${22 * rows - 16})` });
      g.append(...[...one("svg", item).cloneNode(true).childNodes], tag("text", { class: "legend", x: 34, y: 11.5 }, item.textContent));
      x += long;
      return g;
    });
    copy.setAttribute("viewBox", `0 ${-22 * rows} ${size.width} ${size.height + 22 * rows}`);
    legend.forEach(g => g.setAttribute("transform", g.getAttribute("transform").replace(/ (-?\d+)/, (_, y) => " " + (y - 22 * rows))));
    copy.setAttribute("width", size.width);
    copy.setAttribute("height", size.height + 22 * rows);
    const points = px => Math.ceil(px * 0.75) + "pt";
    const sheet = `@page{size:${points(size.width)} ${points(size.height + 22 * rows)};margin:0}`;
    copy.prepend(tag("style", {}, sheet + one("#plot-style").textContent), tag("rect", { class: "paper", y: -22 * rows, width: "100%", height: "100%" }), ...legend);
    return new XMLSerializer().serializeToString(copy);
  };
  // The drawing alone, on a page of its size: the browser's dialog has PDF.
  const pdf = () => {
    const alone = make("div", { className: "alone", innerHTML: drawing() });
    document.body.append(alone);
    addEventListener("afterprint", () => alone.remove(), { once: true });
    print();
  };
  const actions = { in: () => enlarge(0.5), out: () => enlarge(2), whole: reset, csv: () => save(name + ".csv", csv()), svg: () => save(name + ".svg", drawing()), pdf };
  for (const button of all("[data-do]", figure)) button.addEventListener("click", () => actions[button.dataset.do]());
}
