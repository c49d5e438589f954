window.lwaTurn = {row, theory, toRest, LATTICES, calculate, drawRecord, things};
document.querySelectorAll(".lwa-calculator").forEach(calculator);
for (const [name, thing] of Object.entries(things)) {
  document.querySelectorAll(`.lwa-${name}`).forEach(home => stage(home, thing));
}
