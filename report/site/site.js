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

function interactive(figure) {
  const button = figure.querySelector("button");
  const name = figure.dataset.scene;
  button.addEventListener("click", async () => {
    button.disabled = true;
    if (!window.Plotly) await loaded("plotly.min.js");
    await loaded("scenes/" + name + ".js");
    const stage = figure.querySelector(".stage");
    stage.replaceChildren();
    const scene = smallsatScenes[name];
    const ink = getComputedStyle(document.body).color;
    scene.layout.font = { color: ink };
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) delete scene.layout.updatemenus;
    await Plotly.newPlot(stage, scene.data, scene.layout, { responsive: true, displaylogo: false });
    if (scene.frames) await Plotly.addFrames(stage, scene.frames);
    stage.setAttribute("role", "img");
    stage.setAttribute("aria-label", figure.querySelector("figcaption").textContent);
    button.remove();
  });
}

document.querySelectorAll("form[data-filters]").forEach(filtered);
document.querySelectorAll("figure.scene").forEach(interactive);
