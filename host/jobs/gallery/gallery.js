"use strict";
(() => {
const pairs = JSON.parse(document.getElementById("data").textContent);
const $ = id => document.getElementById(id);
function element(tag, content, attributes = {}) {
    const e = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    e.append(...[content ?? ""].flat());
    return e;
}
const number = (x, digits = 3) => x === null ? "?" : String(Number(x.toPrecision(digits)));
const percent = x => x === null ? "?" : `${number(100 * x)} %`;
const baseName = path => path.split("/").pop();
/* A picture's own name, with its folder where others are called the same. */
const name = r => pairs.filter(p => baseName(p.report.a.path) === baseName(r.a.path)).length > 1 ? r.a.path : baseName(r.a.path);

/* The table, and the order of all */
const columns = [
    ["picture", r => name(r), r => name(r)],
    ["verdict", r => Number(!r.differ), r => element("span", r.differ ? "differs" : r.noise_test ? "no more than noise" : "equal", {class: r.differ ? "differ" : "alike"})],
    ["error", r => r.error, r => percent(r.error)],
    ["noise alone", r => r.error_of_noise, r => r.error_of_noise === null ? "" : percent(r.error_of_noise)],
    ["FLIP", r => r.flip, r => number(r.flip)],
    ["SSIM", r => r.ssim, r => r.ssim === null ? "?" : r.ssim.toFixed(4)],
    ["PSNR", r => r.psnr, r => r.psnr === null ? "" : `${r.psnr.toFixed(1)} dB`],
    ["p", r => r.noise_test?.p ?? null, r => !r.noise_test ? "" : r.noise_test.p < 1e-99 ? "< 1e-99" : number(r.noise_test.p, 2)],
].filter(([, key]) => pairs.some(p => key(p.report) !== null));
let sorted = {column: -1, down: false};
const rows = [], cards = [];
function order() {
    const key = sorted.column < 0 ? null : columns[sorted.column][1];
    const places = pairs.map((_, i) => i);
    if (key) places.sort((i, k) => {
        const [x, y] = [key(pairs[i].report), key(pairs[k].report)];
        if (x === null || y === null) return (x === null) - (y === null); /* what is not known comes last */
        return (sorted.down ? -1 : 1) * (typeof x === "string" ? x.localeCompare(y) : x - y) || i - k;
    });
    $("table").tBodies[0].append(...places.map(i => rows[i]));
    $("gallery").append(...places.map(i => cards[i]));
    $("table").querySelectorAll("thead th").forEach((th, i) => {
        if (i === sorted.column) th.setAttribute("aria-sort", sorted.down ? "descending" : "ascending");
        else th.removeAttribute("aria-sort");
    });
}
function fillTable() {
    const head = columns.map(([title], i) => {
        const button = element("button", title, {type: "button"});
        button.addEventListener("click", () => {
            sorted = {column: i, down: sorted.column === i ? !sorted.down : ["error", "noise alone", "FLIP"].includes(title)}; /* the worst first */
            order();
        });
        return element("th", button, {scope: "col"});
    });
    for (const [i, {report}] of pairs.entries()) {
        const link = element("a", columns[0][2](report), {href: `#pair-${i}`, title: report.a.path});
        rows.push(element("tr", [element("td", link), ...columns.slice(1).map(c => element("td", c[2](report)))], {"data-pair": i}));
    }
    $("table").append(element("thead", element("tr", head)), element("tbody"));
}

/* Views */
const views = {
    wipe: ["wipe", "Drag over a picture, or use the slider below it: A on the left, B on the right."],
    blink: ["blink", "A and B in turn. The space bar stops and continues."],
    difference: ["difference", "|A − B| of the sRGB values, times the factor."],
    error: ["error map", "The difference relative to B, from 0.1 % (black) over red to 100 % (pale yellow); grey is not compared."],
    flip: ["FLIP", "How different they look: black means alike, pale yellow as different as possible; grey is not compared."],
    a: ["A", "The pictures compared."],
    b: ["B", "The references."],
};
let timer = 0;
const isStill = matchMedia("(prefers-reduced-motion: reduce)");
function blink(on) {
    clearInterval(timer);
    timer = on ? setInterval(() => document.body.classList.toggle("other"), 600) : 0;
}
function show(view) {
    document.body.dataset.view = view;
    $(`view-${view}`).checked = true;
    $("view-help").textContent = views[view][1] + (view === "blink" && isStill.matches ? " It stands still, since this system asks for reduced motion; the space bar changes the picture." : "");
    blink(view === "blink" && !isStill.matches);
}
function listViews() {
    for (const [view, [title]] of Object.entries(views)) {
        const radio = element("input", "", {type: "radio", name: "view", id: `view-${view}`});
        radio.addEventListener("change", () => show(view));
        $("views").append(element("label", [radio, title]));
    }
    addEventListener("keydown", e => {
        if (e.key !== " " || document.body.dataset.view !== "blink" || e.target.closest?.("button, select, input:not([name=view])")) return;
        e.preventDefault();
        if (isStill.matches) document.body.classList.toggle("other");
        else blink(!timer);
    });
}

/* Cards */
function card({report, ...pictures}, i) {
    const label = {a: "A", b: "B", error: "Error map", flip: "FLIP map"};
    const stage = element("div", [
        ...["b", "a", "error", "flip"].map(kind => element("img", "", {class: kind, src: pictures[kind], alt: `${label[kind]} of ${name(report)}`, draggable: "false"})),
        element("div", "", {class: "bar"}), element("span", "A", {class: "name of-a"}), element("span", "B", {class: "name of-b"})], {class: "stage"});
    stage.style.aspectRatio = `${report.width} / ${report.height}`;
    const wipe = element("input", "", {type: "range", min: 0, max: 100, step: "any", value: 50, class: "wipe", "aria-label": `Wipe of ${name(report)}`});
    wipe.addEventListener("input", () => stage.style.setProperty("--at", `${wipe.value}%`));
    const drag = e => {
        if (document.body.dataset.view !== "wipe" || (e.type === "pointermove" && !e.buttons)) return;
        const box = stage.getBoundingClientRect();
        wipe.value = 100 * (e.clientX - box.left) / box.width;
        stage.style.setProperty("--at", `${wipe.value}%`);
    };
    for (const event of ["pointerdown", "pointermove"]) stage.addEventListener(event, drag);
    const verdict = columns[1][2](report), space = report.space === "linear" ? "" :
        [!report.a.format && "A", !report.b.format && "B"].filter(Boolean).length ? `, tone curve ${report.tonemap}${report.exposure ? `, exposure ${report.exposure > 0 ? "+" : ""}${number(report.exposure)}${report.exposure_fitted ? " (fitted)" : ""}` : ""}` : "";
    return element("article", [
        element("h3", name(report)),
        element("p", [verdict, ` — error ${percent(report.error)}, FLIP ${number(report.flip)}, SSIM ${report.ssim === null ? "?" : report.ssim.toFixed(4)}`]),
        element("div", stage, {class: "frame"}), wipe,
        element("p", `A: ${report.a.path}. B: ${report.b.path}. ${report.width} × ${report.height} pixels${space}.`, {class: "help"})], {id: `pair-${i}`});
}
function resize() {
    const times = Number($("size").value);
    $("gallery").classList.toggle("sized", times > 0);
    $("gallery").style.setProperty("--wide", `${times * Math.max(...pairs.map(p => p.report.width))}px`);
    cards.forEach((c, i) => c.querySelector(".stage").style.width = times ? `${times * pairs[i].report.width}px` : "");
}
function gain() {
    const factor = 2 ** Number($("gain").value);
    document.documentElement.style.setProperty("--gain", factor);
    $("gain-value").textContent = `${factor}`;
}
function choose() {
    cards.forEach((c, i) => c.hidden = $("differing").checked && !pairs[i].report.differ);
}

const differing = pairs.filter(p => p.report.differ).length;
$("summary").textContent = pairs.length === 1 ? (differing ? "They differ." : "They do not differ.") : `${differing} of ${pairs.length} differ.`;
fillTable();
listViews();
cards.push(...pairs.map(card));
order();
$("size").addEventListener("change", resize);
$("gain").addEventListener("input", gain);
$("differing").addEventListener("change", choose);
gain();
show("wipe");
globalThis.eclat = {pairs, isBlinking: () => timer !== 0};
})();
