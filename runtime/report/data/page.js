// Moves each part through its places, between them in proportion.  It stands still where less
// motion is wanted, and can be stopped and moved by hand.
(() => {
  const svg = document.querySelector("svg[data-angles]");
  if (!svg) return;
  const controls = document.querySelector(".controls");
  const [button, slider, output] = ["button", "input", "output"].map(
    name => controls.querySelector(name));
  const angles = svg.dataset.angles.split(" ").map(Number);
  const parts = [...svg.querySelectorAll("[data-poses]")].map(part => [part,
    part.dataset.poses.split(";").map(pose => pose.split(" ").map(Number))]);
  let at = 0, before = 0;
  let playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  const show = () => {
    const i = Math.floor(at) % angles.length, j = (i + 1) % angles.length, part = at % 1;
    for (const [element, poses] of parts) {
      const place = poses[i].map((value, k) => value + part * (poses[j][k] - value));
      if (element.tagName === "circle") {
        element.setAttribute("cx", place[0]);
        element.setAttribute("cy", place[1]);
      } else element.setAttribute("points", place.map(value => value.toFixed(2)).join(" "));
    }
    slider.value = i;
    output.textContent = `crank at ${Math.round(angles[i])}°`;
  };
  const tick = now => {
    if (!playing) return;
    at = (at + (now - before) / 1000 * angles.length / svg.dataset.seconds) % angles.length;
    before = now;
    show();
    requestAnimationFrame(tick);
  };
  const play = wanted => {
    playing = wanted;
    button.textContent = playing ? "Pause" : "Play";
    if (playing) requestAnimationFrame(now => { before = now; tick(now); });
  };
  button.addEventListener("click", () => play(!playing));
  slider.addEventListener("input", () => { play(false); at = Number(slider.value); show(); });
  controls.hidden = false;
  show();
  play(playing);
})();
