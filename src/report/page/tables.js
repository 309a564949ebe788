// Tables: packed into the page, unpacked when one is opened or something is looked for.
const packed = one("#rows"), find = one("#find"), AT_ONCE = 20;
let unpacking = null;
const unpack = () => unpacking ||= (async () => {
  const bytes = Uint8Array.from(atob(packed.textContent), letter => letter.charCodeAt(0));
  const text = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
  return new Map(JSON.parse(text).map(entry => [entry.name, entry]));
})();
const cell = value => value === null ? "–" : typeof value === "number" ? shown(value, 6) : String(value);
const region = (label, ...children) => {
  const wide = make("div", { className: "wide", tabIndex: 0 }, ...children);
  wide.setAttribute("role", "region");
  wide.setAttribute("aria-label", label);
  return wide;
};
const heading = (scope, className, ...children) => make("th", { scope, className }, ...children);
const fill = (details, entry, wanted) => {
  const body = one(".body", details), { columns, values } = entry, count = values.length ? values[0].length : 0;
  const row = index => values.map(column => column[index]);
  let matching = [...Array(count).keys()];
  if (wanted) {
    const hits = matching.filter(index => row(index).some(value => cell(value).toLowerCase().includes(wanted)));
    // The table's name or columns may be what was looked for.
    if (hits.length) matching = hits;
  }
  const number = index => columns[index].kind === "float" || columns[index].kind === "integer" ? "n" : "";
  const tbody = make("tbody", {}), more = make("button", { type: "button" });
  const add = () => {
    const next = matching.splice(0, AT_ONCE);
    tbody.append(...next.map(index => make("tr", {}, ...row(index).map((value, column) =>
      column ? make("td", { className: number(column) }, cell(value)) : heading("row", number(column), make("span", { className: "k" }, cell(value)))))));
    more.textContent = `${Math.min(AT_ONCE, matching.length)} more of ${matching.length}`;
    more.hidden = !matching.length;
  };
  more.addEventListener("click", add);
  add();
  const head = columns.map((column, index) => heading("col", number(index), column.name, ...column.unit ? [make("div", { className: "place" }, column.unit)] : []));
  const csv = make("button", { type: "button" }, "CSV");
  csv.addEventListener("click", () => save(entry.name + ".csv", table([columns.map(column => column.unit ? `${column.name} [${column.unit}]` : column.name), ...Array.from({ length: count }, (_, index) => row(index))])));
  const meanings = columns.map(column => make("tr", {}, heading("row", "", make("span", { className: "k" }, make("code", {}, column.name))), make("td", {}, column.unit), make("td", {}, column.meaning)));
  const part = count < entry.rows ? make("p", { className: "place" }, `the first ${count} of ${entry.rows} rows; all of them are in the file`) : "";
  const data = make("table", { className: "data" }, make("thead", {}, make("tr", {}, ...head)), tbody);
  const absent = make("p", { className: "place" }, `${entry.rows} rows, too many for a page; all of them are in the file`);
  body.replaceChildren(...!count && entry.rows ? [absent] : [], ...count ? [region(`Rows of ${entry.name}`, data), part, make("p", { className: "tools" }, more, csv)] : [],
    make("details", {}, make("summary", {}, "What the columns mean"), region(`Columns of ${entry.name}`, make("table", {},
      make("thead", {}, make("tr", {}, ...["Column", "Unit", "Meaning"].map(name => heading("col", "", name)))), make("tbody", {}, ...meanings)))));
};
if (packed) {
  const entries = all("details.table"), wanted = () => find.value.trim().toLowerCase();
  for (const details of entries) details.addEventListener("toggle", async () => {
    if (details.open) fill(details, (await unpack()).get(details.dataset.table), wanted());
  });
  find.addEventListener("input", async () => {
    const known = await unpack(), text = wanted();
    let count = 0;
    for (const details of entries) {
      const entry = known.get(details.dataset.table);
      const said = [entry.name, details.textContent, ...entry.columns.map(column => column.name + " " + column.meaning)].join(" ").toLowerCase();
      const found = !text || said.includes(text) || entry.values.some(column => column.some(value => cell(value).toLowerCase().includes(text)));
      details.hidden = !found;
      count += found;
      if (found && details.open) fill(details, entry, text);
    }
    for (const group of all(".stage-tables")) group.hidden = !one("details.table:not([hidden])", group);
    one("#found").textContent = text ? `${count} of ${entries.length} tables` : "";
  });
}
