// Filters of the table of values, and scenes that are loaded when they are asked for.
"use strict";
var smallsatScenes = {};

function filtered(form) {
  const rows = document.querySelectorAll("#" + form.dataset.filters + " tbody tr");
  const apply = () => {
    const words = form.elements.text.value.toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = ["study", "kind", "verdict"].filter((name) => form.elements[name].value);
    let shown = 0;
    for (const row of rows) {
      const text = row.textContent.toLowerCase();
      const good =
        wanted.every((name) => row.dataset[name] === form.elements[name].value) &&
        words.every((word) => text.includes(word));
      row.hidden = !good;
      shown += good;
    }
    form.elements.count.value = shown + " of " + rows.length;
  };
  form.addEventListener("input", apply);
  form.addEventListener("submit", (event) => event.preventDefault());
  apply();
}

function loaded(source) {
  return new Promise((done, failed) => {
    const script = document.createElement("script");
    script.src = source;
    script.onload = done;
    script.onerror = () => failed(new Error(source + " is missing; build the site again"));
    document.head.append(script);
  });
}

const FRAME_MS = 60;
const TURN = Math.PI / 36;
const ZOOM = 1.1;
// What a key does to azimuth, elevation and distance of the eye.
const KEYS = {
  ArrowLeft: [-TURN, 0, 1], ArrowRight: [TURN, 0, 1],
  ArrowUp: [0, TURN, 1], ArrowDown: [0, -TURN, 1],
  "+": [0, 0, 1 / ZOOM], "-": [0, 0, ZOOM],
};

function turnedByKeys(stage) {
  stage.tabIndex = 0;
  stage.addEventListener("keydown", (event) => {
    if (!(event.key in KEYS) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const [around, up, away] = KEYS[event.key];
    const { x, y, z } = stage.layout.scene.camera.eye;
    const far = Math.hypot(x, y, z) * away;
    const azimuth = Math.atan2(y, x) + around;
    const elevation = Math.max(-1.5, Math.min(1.5, Math.asin(z * away / far) + up));
    const flat = far * Math.cos(elevation);
    const eye = { x: flat * Math.cos(azimuth), y: flat * Math.sin(azimuth), z: far * Math.sin(elevation) };
    Plotly.relayout(stage, { "scene.camera.eye": eye });
  });
}

// The button that asked for the scene now plays it, so that the keyboard stays where it is.
function playedBy(button, stage) {
  const name = (playing) => { button.textContent = playing ? "Pause" : "Play"; };
  name(false);
  button.addEventListener("click", () => {
    const play = button.textContent === "Play";
    name(play);
    const options = { frame: { duration: FRAME_MS, redraw: true }, fromcurrent: true, mode: "immediate" };
    // Plotly breaks off the play by refusing its promise.
    Plotly.animate(stage, play ? null : [null], options).then(() => name(false), () => {});
  });
}

function interactive(figure) {
  const button = figure.querySelector("button");
  const name = figure.dataset.scene;
  const show = async () => {
    button.textContent = "Loading";
    if (!window.Plotly) await loaded("plotly.min.js");
    await loaded("scenes/" + name + ".js");
    const stage = figure.querySelector(".stage");
    stage.replaceChildren();
    const scene = smallsatScenes[name];
    scene.layout.font = { color: getComputedStyle(document.body).color };
    await Plotly.newPlot(stage, scene.data, scene.layout, { responsive: true, displaylogo: false });
    await Plotly.addFrames(stage, scene.frames);
    stage.setAttribute("role", "img");
    stage.setAttribute("aria-label", figure.querySelector("figcaption").textContent);
    turnedByKeys(stage);
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) {
      button.remove();
      stage.focus();
    } else playedBy(button, stage);
  };
  button.addEventListener("click", show, { once: true });
}

document.querySelectorAll("form[data-filters]").forEach(filtered);
document.querySelectorAll("figure.scene").forEach(interactive);
