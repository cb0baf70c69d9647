// With #selftest the page plays itself once and writes what it found to <html data-selftest>.
async function selfTest(state) {
  const wait = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
  const pixels = () => state.maps.map(({ canvas }) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let sum = 0;
    for (let k = 0; k < data.length; k += 1) sum = (31 * sum + data[k]) | 0;
    return sum;
  });
  const slide = (step) => {
    byId("slider").value = step;
    byId("slider").dispatchEvent(new Event("input", { bubbles: true }));
    return pixels();
  };
  const found = { episodes: state.page.episodes.length, steps: state.last };
  found.titles = state.page.episodes.map((one) => one.title);
  const begin = slide(0);
  const middle = slide(Math.floor(state.last / 2));
  found.sliderMoves = begin.some((sum, place) => sum !== middle[place]);
  found.back = JSON.stringify(slide(0)) === JSON.stringify(begin);
  state.speed = 60;
  byId("play").click();
  for (let k = 0; k < 100 && state.step < 1; k++) await wait(20);
  byId("play").click();
  found.played = state.step;
  document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "End", bubbles: true }));
  found.keyboard = state.step === state.last;
  found.cutTitles = [...document.querySelectorAll(".map strong")].filter((it) => it.scrollWidth > it.clientWidth).map((it) => it.textContent);
  found.panels = {};
  for (const map of state.maps) {
    state.look(map);
    for (const name of Object.keys(PANELS)) {
      state.open(name);
      found.panels[name] = Math.max(found.panels[name] || 0, byId("panel").textContent.length);
    }
  }
  state.shows.skills = state.shows.team = true;
  state.open("messages");
  found.messages = byId("panel").querySelectorAll(".messages li").length;
  found.decisions = 0;
  for (const map of state.maps) {
    state.look(map);
    state.open("decisions");
    for (const one of state.decisionsOf(map.episode).slice(0, 40)) {
      state.go(one.step, one);
      for (const item of byId("panel").querySelectorAll("details")) {
        item.open = true;
        item.dispatchEvent(new Event("toggle"));
      }
      found.decisions += 1;
      found.prompts = (found.prompts || 0) + byId("panel").querySelectorAll("pre").length;
      found.foreign = (found.foreign || 0) + byId("panel").querySelectorAll("script, iframe, object, embed, link, a, svg, img:not(.eye)").length;
      found.pictures = (found.pictures || 0) + [...byId("panel").querySelectorAll("img.eye")].filter((it) => it.src.startsWith("data:image/jpeg")).length;
    }
  }
  await wait(50);
  found.scripts = document.querySelectorAll("script").length;
  found.wide = document.documentElement.scrollWidth > window.innerWidth;
  found.troubles = troubles;
  document.documentElement.dataset.selftest = JSON.stringify(found);
}
