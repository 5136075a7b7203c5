// The comparisons: two images over each other, with a slider between them.
for (const compare of document.querySelectorAll(".compare")) {
  const under = compare.querySelector(".under");
  const over = compare.querySelector(".over img");
  const clip = compare.querySelector(".over");
  const slider = compare.querySelector("input");
  const [left, right] = compare.querySelectorAll("select");
  const show = (image, choice) => {
    const chosen = choice.selectedOptions[0];
    image.src = choice.value;
    image.alt = `${chosen.textContent}, ${compare.dataset.view}`;
  };
  const move = () => {
    clip.style.clipPath = `inset(0 0 0 ${slider.value}%)`;
    clip.style.setProperty("--at", `${slider.value}%`);
    slider.setAttribute("aria-valuetext",
      `${left.selectedOptions[0].textContent} on the left ${slider.value} percent`);
  };
  left.addEventListener("change", () => { show(under, left); move(); });
  right.addEventListener("change", () => { show(over, right); move(); });
  slider.addEventListener("input", move);
  move();
}
