"use strict";
(() => {
const data = JSON.parse(document.getElementById("data").textContent);
const images = JSON.parse(document.getElementById("images").textContent);
const $ = id => document.getElementById(id);
const measured = data.rungs.filter(r => r.state === "measured");
const base = measured.find(r => r.id === "path");
const leavesOut = r => r.group === "effect" || r.group === "lights";
const curves = measured.filter(r => r.curve && !leavesOut(r) && r.curve.some(p => p.error !== null));
const effects = measured.filter(leavesOut);

/* Words and figures */
const percent = (x, digits = 3) => x === null || !isFinite(x) ? "?" : `${Number((100 * x).toPrecision(digits))} %`;
const number = (x, digits = 3) => x === null || x === undefined ? "?" : String(Number(x.toPrecision(digits)));
function seconds(s) {
    if (s === null) return "?";
    const [size, unit] = s >= 86400 ? [86400, "d"] : s >= 3600 ? [3600, "h"] : s >= 99.5 ? [60, "min"] : s >= 1 ? [1, "s"] : [1e-3, "ms"];
    return `${Number((s / size).toPrecision(3))} ${unit}`;
}
function bytes(b) {
    const units = ["B", "KiB", "MiB", "GiB"];
    let i = 0;
    while (b >= 1023.5 && i < 3) b /= 1024, i++;
    return `${Number(b.toPrecision(3))} ${units[i]}`;
}
function element(tag, content, attributes = {}) {
    const e = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    e.append(...[content ?? ""].flat());
    return e;
}
const label = r => r.label;

/* Colours that differ in hue and lightness, on both grounds. */
const hues = {
    light: ["#1d1d1f", "#0b6bcb", "#c2410c", "#15803d", "#9333ea", "#be185d", "#0e7490", "#a16207", "#4d7c0f", "#7c5cd6", "#b45309", "#475569"],
    dark: ["#ffffff", "#6cb6ff", "#ff9a5c", "#6fdd8b", "#c99bff", "#ff85b3", "#5fd3e8", "#f2cc60", "#b5e05a", "#a9b8ff", "#ffc38a", "#a7b0bd"],
};
const shapes = ["circle", "rect", "triangle", "rectRot", "crossRot", "star", "rectRounded", "cross"];
const darkness = matchMedia("(prefers-color-scheme: dark)");
const hue = i => hues[darkness.matches ? "dark" : "light"][i % 12];
const style = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/* The chart of error against time */
const shown = new Set(curves.map(r => r.id));
const metric = () => $("metric").value;
const errorOf = p => metric() === "mse" ? p.error : p.relmse > 0 ? Math.sqrt(p.relmse) : null;
const spread = p => metric() === "mse" ? p.error_se : p.relmse > 0 ? 0.5 * p.relmse_se / Math.sqrt(p.relmse) : null;
const points = r => r.curve.map(p => ({x: p.seconds, y: errorOf(p), point: p})).filter(p => p.y !== null && p.y > 0);

/* As the C side makes it for the first metric; here for both, of the curves that are shown. */
function front() {
    const known = p => metric() === "mse" ? p.mse > 2 * p.mse_se : p.relmse > 2 * p.relmse_se;
    const all = curves.filter(r => shown.has(r.id)).flatMap(points).filter(p => known(p.point)).sort((a, b) => a.x - b.x || a.y - b.y);
    const best = [];
    for (const p of all) if (!best.length || p.y < best[best.length - 1].y) best.push(p);
    return best.map(({x, y}) => ({x, y}));
}
/* Through the middle of the base's curve, as wide as the chart's points. */
function guide() {
    const own = base ? points(base) : [], all = curves.filter(r => shown.has(r.id)).flatMap(points);
    if (!own.length || !all.length) return [];
    const through = own[0], xs = all.map(p => p.x);
    return [Math.min(...xs), Math.max(...xs)].map(x => ({x, y: through.y * Math.sqrt(through.x / x)}));
}
function slopeText(r) {
    return r.slope === null ? "slope ?" : `slope ${r.slope.toFixed(2)} ± ${r.slope_se.toFixed(3)}`;
}
function datasets() {
    const sets = curves.map((r, i) => ({
        label: label(r), rung: r, data: points(r), hidden: !shown.has(r.id), showLine: true, order: 1,
        borderColor: hue(i), backgroundColor: hue(i), borderWidth: r === base ? 3 : 2, pointStyle: shapes[i % 8], pointRadius: 4,
        pointHoverRadius: 7, borderDash: r.unbiased_by_design ? [] : [6, 4],
    }));
    if ($("show-front").checked)
        sets.push({label: "Pareto front", data: front(), showLine: true, stepped: "before", pointRadius: 0, pointHitRadius: 0, borderWidth: 9, order: 3,
                   borderColor: darkness.matches ? "#ffffff2e" : "#0000001c"});
    if ($("show-guide").checked)
        sets.push({label: "slope −½", data: guide(), showLine: true, pointRadius: 0, pointHitRadius: 0, borderWidth: 1.5, borderDash: [2, 4], order: 2, borderColor: style("--quiet")});
    return sets;
}
const ticks125 = (value, text) => /^[125]0*$/.test(String(Number(value.toPrecision(2))).replace(/^0\.0*/, "")) ? text(value) : null;
function axis(title, text) {
    return {type: "logarithmic", title: {display: true, text: title, color: style("--text")}, grid: {color: style("--line")},
            ticks: {color: style("--quiet"), autoSkip: true, maxRotation: 0, callback: v => ticks125(v, text)}};
}
const describe = (r, p) => `${label(r)}: ${percent(errorOf(p))} ± ${percent(spread(p), 2)} after ${seconds(p.seconds)}, ${p.samples_per_pixel} samples a pixel, ${slopeText(r)}`;
/* Standard errors as whiskers, of one to each side. */
const whiskers = {id: "whiskers", afterDatasetsDraw(chart) {
    const {ctx, scales: {y}} = chart;
    chart.data.datasets.forEach((set, i) => {
        if (!set.rung || set.hidden) return;
        ctx.strokeStyle = set.borderColor;
        ctx.lineWidth = 1.2;
        chart.getDatasetMeta(i).data.forEach((dot, k) => {
            const {y: error, point} = set.data[k], se = spread(point);
            ctx.beginPath();
            ctx.moveTo(dot.x, Math.min(y.getPixelForValue(Math.max(error - se, error / 10)), chart.chartArea.bottom));
            ctx.lineTo(dot.x, Math.max(y.getPixelForValue(error + se), chart.chartArea.top));
            ctx.stroke();
        });
    });
}};
/* Each curve's name beside the chart, one below the other, with a line to the curve's end. */
const names = {id: "names", afterDatasetsDraw(chart) {
    const {ctx, chartArea} = chart, ends = [];
    if (chart.width < 700) return; /* the list below has them */
    chart.data.datasets.forEach((set, i) => {
        const dots = chart.getDatasetMeta(i).data;
        if (set.rung && !set.hidden && dots.length) ends.push({text: label(set.rung), colour: set.borderColor, x: dots[dots.length - 1].x, y: dots[dots.length - 1].y});
    });
    ends.sort((a, b) => a.y - b.y);
    let free = chartArea.top;
    ctx.font = "12px system-ui, sans-serif";
    ctx.textBaseline = "middle";
    ctx.lineWidth = 0.7;
    ends.forEach((end, i) => {
        const at = Math.max(free, Math.min(end.y, chartArea.bottom - 14 * (ends.length - i)));
        ctx.fillStyle = ctx.strokeStyle = end.colour;
        ctx.beginPath();
        ctx.moveTo(end.x + 5, end.y);
        ctx.lineTo(chartArea.right + 6, at);
        ctx.stroke();
        ctx.fillText(end.text.length > 20 ? `${end.text.slice(0, 19)}…` : end.text, chartArea.right + 9, at);
        free = at + 14;
    });
    globalThis.eclat && (globalThis.eclat.named = ends.map(end => end.text));
}};
let errorChart, effectsChart;
function drawErrors() {
    errorChart?.destroy();
    errorChart = new Chart($("error-chart"), {
        type: "scatter",
        data: {datasets: datasets()},
        plugins: [whiskers, names],
        options: {
            animation: false, maintainAspectRatio: false, layout: {padding: {right: $("error-box").clientWidth < 700 ? 0 : 130}}, events: ["mousemove", "mouseout", "click", "touchstart", "touchmove"],
            interaction: {mode: "nearest", intersect: false},
            scales: {x: axis("time of one picture", seconds), y: axis("error", percent)},
            plugins: {legend: {display: false}, tooltip: {
                filter: item => !!item.dataset.rung,
                callbacks: {label: item => [label(item.dataset.rung), `error ${percent(item.raw.y)} ± ${percent(spread(item.raw.point), 2)}`,
                    `${seconds(item.raw.x)}, ${item.raw.point.samples_per_pixel} samples a pixel`, slopeText(item.dataset.rung)]},
            }},
        },
    });
}

/* Keyboard: one point of one curve at a time. */
const place = {curve: 0, point: 0};
function visit(curve, point) {
    const visible = errorChart.data.datasets.map((set, index) => ({set, index})).filter(s => s.set.rung && !s.set.hidden && s.set.data.length);
    if (!visible.length) return;
    place.curve = (curve + visible.length) % visible.length;
    const {set, index} = visible[place.curve];
    place.point = Math.max(0, Math.min(point, set.data.length - 1));
    const active = [{datasetIndex: index, index: place.point}];
    errorChart.setActiveElements(active);
    errorChart.tooltip.setActiveElements(active, {x: 0, y: 0});
    errorChart.update();
    $("error-live").textContent = describe(set.rung, set.data[place.point].point);
}
$("error-chart").addEventListener("keydown", event => {
    const step = {ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0], Home: [0, -1e9], End: [0, 1e9]}[event.key];
    if (event.key === "Escape") {
        errorChart.setActiveElements([]);
        errorChart.tooltip.setActiveElements([], {x: 0, y: 0});
        errorChart.update();
        $("error-live").textContent = "";
    }
    if (!step) return;
    event.preventDefault();
    visit(place.curve + step[0], place.point + step[1]);
});
$("error-chart").addEventListener("focus", () => { if (!$("error-live").textContent) visit(place.curve, place.point); });

function listCurves() {
    curves.forEach((r, i) => {
        const box = element("input", "", {type: "checkbox", id: `curve-${r.id}`});
        box.checked = true;
        box.addEventListener("change", () => { box.checked ? shown.add(r.id) : shown.delete(r.id); drawErrors(); });
        const swatch = element("span", "", {class: "swatch"});
        swatch.style.background = hue(i);
        darkness.addEventListener("change", () => { swatch.style.background = hue(i); });
        $("curves").append(element("label", [box, swatch, `${label(r)}, ${slopeText(r)}`]));
    });
    const set = on => {
        for (const r of curves) $(`curve-${r.id}`).checked = on, on ? shown.add(r.id) : shown.delete(r.id);
        drawErrors();
    };
    $("all").addEventListener("click", () => set(true));
    $("none").addEventListener("click", () => set(false));
    for (const id of ["metric", "show-front", "show-guide"]) $(id).addEventListener("change", drawErrors);
}

/* Effects */
const effectRows = effects.map(r => ({
    name: r.name, rung: r, time: 1 - r.relative_time, noise: base && base.variance > 0 ? 1 - r.variance / base.variance : null,
    difference: r.bias_squared > 0 ? Math.sqrt(r.bias_squared) : 0,
    uncertain: Math.sqrt(Math.max(r.bias_squared, 0) + 2 * r.bias_squared_se),
}));
function drawEffects() {
    effectsChart?.destroy();
    if (!effectRows.length) { $("effects-section").hidden = true; return; }
    $("effects-box").style.height = `${6 + 3.6 * effectRows.length}rem`;
    const cut = 120;
    const bars = [["time", "time of a sample", 1], ["noise", "variance of a sample", 2], ["difference", "error of leaving it out", 3]];
    effectsChart = new Chart($("effects-chart"), {
        type: "bar",
        data: {labels: effectRows.map(e => e.name), datasets: bars.map(([key, title, i]) => (
            {label: title, data: effectRows.map(e => e[key] === null ? null : 100 * e[key]), backgroundColor: hue(i)}))},
        options: {
            indexAxis: "y", animation: false, maintainAspectRatio: false,
            scales: {x: {title: {display: true, text: "%", color: style("--text")}, grid: {color: style("--line")}, ticks: {color: style("--quiet")}, suggestedMin: 0, min: Math.max(-cut, Math.min(0, ...effectRows.flatMap(e => [100 * e.time, 100 * e.noise]))), max: Math.min(cut, Math.max(10, ...effectRows.flatMap(e => [100 * e.time, 100 * e.noise, 100 * e.difference])))},
                     y: {grid: {display: false}, ticks: {color: style("--text"), callback(v) { const t = this.getLabelForValue(v); return t.length > 24 ? `${t.slice(0, 23)}…` : t; }}}},
            plugins: {legend: {position: "top", labels: {color: style("--text")}}, tooltip: {callbacks: {label: item => `${item.dataset.label}: ${number(item.raw)} %`}}},
        },
    });
}
function tableEffects() {
    const head = element("thead", element("tr", ["without", "time of a sample", "variance of a sample", "error of leaving it out"].map(t => element("th", t, {scope: "col"}))));
    const body = element("tbody", effectRows.map(e => element("tr", [
        element("th", e.name, {scope: "row"}),
        element("td", `${e.time >= 0 ? "−" : "+"}${percent(Math.abs(e.time), 2)} ± ${percent(e.rung.relative_time_se, 2)}`, {"data-value": e.rung.relative_time}),
        element("td", e.noise === null ? "?" : `${e.noise >= 0 ? "−" : "+"}${percent(Math.abs(e.noise), 2)}`, {"data-value": e.rung.variance}),
        element("td", e.rung.biased ? percent(e.difference) : `< ${percent(e.uncertain, 2)}`, {"data-value": e.rung.bias_squared}),
    ])));
    $("effects-table").append(head, body);
}

/* The table */
function timeTo(r, i) {
    const t = r.time_to?.[i];
    if (!t) return {text: ""};
    if (r.light_not_met) return {text: "?", value: t.seconds};
    if (t.never) return {text: "never"};
    return {text: t.seconds === null ? "?" : (t.extrapolated ? "~ " : "") + seconds(t.seconds), value: t.seconds};
}
function bias(r) {
    if (r.same_bits !== undefined) return {text: r.same_bits ? "same bits" : "BITS DIFFER"};
    const bound = Math.sqrt(Math.max(r.bias_squared, 0) + 2 * r.bias_squared_se);
    if (r.biased) return {text: `floor ${percent(r.error_floor)}`, value: r.error_floor, floor: true};
    return {text: r.light_not_met ? `lacks ${percent(Math.sqrt(r.bias_squared))}` : `< ${percent(bound)}`, value: r.bias_squared};
}
const columns = [
    ["time", r => ({text: `×${r.relative_time.toFixed(2)}${r.relative_time_se ? ` ± ${r.relative_time_se.toFixed(2)}` : ""}`, value: r.relative_time})],
    ["slope", r => r.curve ? {text: r.slope === null ? "?" : `${r.slope.toFixed(2)} ± ${r.slope_se.toFixed(3)}`, value: r.slope} : {text: ""}],
    ["variance", r => r.curve ? {text: number(r.variance), value: r.variance} : {text: ""}],
    ["bias", bias],
    ["efficiency 1/s", r => r.curve ? {text: number(r.efficiency), value: r.efficiency} : {text: ""}],
    ...[0, 1, 2, 3].map(i => [`to ${["5", "2", "1", "0.5"][i]} %`, r => timeTo(r, i)]),
    ["memory", r => ({text: bytes(r.device_bytes), value: r.device_bytes})],
];
function fillTable() {
    const head = element("thead", element("tr", ["rung", ...columns.map(c => c[0])].map(t => element("th", t, {scope: "col"}))));
    const body = element("tbody");
    let group = "";
    for (const r of data.rungs) {
        if (r.group !== group) body.append(element("tr", element("th", r.group_title, {colspan: columns.length + 1, scope: "colgroup"})));
        group = r.group;
        const row = element("tr", element("th", r.name, {scope: "row", title: r.name}), {"data-id": r.id});
        if (r.state !== "measured") row.append(element("td", r.note ?? r.state, {colspan: columns.length, class: "note"}));
        else columns.forEach(([name, cell]) => {
            const c = cell(r), td = element("td", c.text, {"data-column": name});
            if (typeof c.value === "number") td.dataset.value = c.value;
            if (data.best[name] === r.id) td.className = "best";
            if (c.floor) td.className = "floor";
            row.append(td);
        });
        body.append(row);
    }
    $("table").append(head, body);
}

/* Pictures */
function showPictures() {
    const figure = (name, text, list, alts) => element("figure", [...list.map((src, i) => element("img", "", {src, alt: alts[i]})), element("figcaption", [element("b", name), element("br"), text])]);
    if (images.reference) {
        const n = data.reference.samples_per_pixel;
        $("pictures").append(figure("reference", `${n ? `${n} samples a pixel` : "from a file"}, error ${percent(data.reference.error)}`, [images.reference], ["The reference"]));
    }
    for (const r of measured) {
        if (!images[r.id]) continue;
        const p = r.curve[r.curve.length - 1];
        $("pictures").append(figure(label(r), `${p.samples_per_pixel} samples a pixel, ${seconds(p.seconds)}, error ${percent(p.error)}`, images[r.id], [`Picture of ${label(r)}`, `Error map of ${label(r)}`]));
    }
}

/* A slider through the times at which some rung's picture is done. */
const staged = measured.filter(r => r.curve && images.stages?.[r.id]?.some(s => s)).map(r => (
    {rung: r, points: r.curve.map((p, i) => ({...p, src: images.stages[r.id][i]})).filter(p => p.src)}));
const times = [...new Set(staged.flatMap(s => s.points.map(p => p.seconds)))].sort((a, b) => a - b);
const lastBy = time => times.findLastIndex(t => t <= time);
function showTime(index) {
    const now = times[index];
    $("time").value = index;
    $("time").setAttribute("aria-valuetext", seconds(now));
    $("time-said").textContent = seconds(now);
    for (const {points, image, empty, caption} of staged) {
        const p = points.findLast(p => p.seconds <= now);
        image.hidden = !p;
        empty.hidden = !!p;
        if (p) image.src = p.src;
        caption.textContent = p ? `${p.samples_per_pixel} samples a pixel, ${seconds(p.seconds)}, error ${percent(p.error)}` : "";
    }
}
function slideThroughTime() {
    if (!times.length) { $("times-section").hidden = true; return; }
    for (const s of staged) {
        s.image = element("img", "", {alt: `Picture of ${label(s.rung)} by then`});
        s.empty = element("div", `none before ${seconds(s.points[0].seconds)}`, {class: "none", style: `aspect-ratio: ${data.width} / ${data.height}`});
        s.caption = element("span");
        $("times").append(element("figure", [s.image, s.empty, element("figcaption", [element("b", label(s.rung)), element("br"), s.caption])]));
    }
    const last = times[times.length - 1], decades = [0.001, 0.01, 0.1, 1, 10, 60, 600, 3600], beyond = [1, 10, 60].filter(t => t > last);
    $("times-reach").textContent = `The longest picture that the budget allowed took ${seconds(last)}`
        + (beyond.length ? `: there is none of ${beyond.map(t => t === 60 ? "1 min" : seconds(t)).join(" and ")}; a larger --budget reaches further.` : ".");
    $("time").max = times.length - 1;
    $("time").addEventListener("input", () => showTime(Number($("time").value)));
    for (const t of decades.filter(t => t >= times[0] && t <= last)) {
        const button = element("button", t === 60 ? "1 min" : seconds(t), {type: "button", "data-seconds": t});
        button.addEventListener("click", () => showTime(lastBy(t)));
        $("time-stops").append(button, " ");
    }
    showTime(times.length - 1);
}

/* Words around them */
function tellStory() {
    const scene = data.scene.split("/").pop();
    document.title = `What accuracy costs: ${scene}`;
    $("title").textContent = `What accuracy costs: ${scene}`;
    $("summary").textContent = `${data.width} × ${data.height} pixels on ${data.device.name}, ${seconds(data.total_seconds)} of ${seconds(data.budget_seconds)} budget${data.interrupted ? ", interrupted: only what was known by then" : ""}.`;
    $("verdict").textContent = data.result;
    const ref = data.reference;
    $("reference").textContent = !ref ? "None: interrupted before." :
        (ref.file ? `The file ${ref.file}` : `The first row's rendering, ${ref.samples_per_pixel} samples a pixel in ${seconds(ref.seconds)}, with seeds that no rung has`) +
        (ref.error === null ? "; it states no error and is taken as exact." : `; its own error is ${percent(ref.error)}, and is subtracted from every figure.`);
    const d = data.device;
    for (const [name, text] of [["command", data.command], ["eclat", data.version], ["scene", data.scene], ["camera", data.camera], ["environment", data.environment],
        ["seed", String(data.seed)], ["device", `${d.name} (${d.type}), ${d.vendor}`], ["driver", `${d.platform}, ${d.platform_version}; driver ${d.driver}`], ["charts", `Chart.js ${Chart.version}, MIT licence`]])
        $("run").append(element("dt", name), element("dd", ["command", "scene"].includes(name) ? element("code", text) : text));
}

tellStory();
listCurves();
fillTable();
tableEffects();
slideThroughTime();
showPictures();
function draw() { drawErrors(); drawEffects(); }
darkness.addEventListener("change", draw);
draw();
globalThis.eclat = {data, charts: () => ({errors: errorChart, effects: effectsChart})};
errorChart.draw();
})();
