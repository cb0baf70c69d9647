// Elements are made here alone. Texts become text nodes: nothing that a robot or a model said is ever markup.
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("aria-")) {
      element.setAttribute(name, readable(String(value)));
      continue;
    }
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "style") Object.assign(element.style, value);
    else element.setAttribute(name, value === true ? "" : readable(String(value)));
  }
  put(element, children);
  return element;
}

function put(element, children) {
  for (const child of children.flat(Infinity)) {
    if (child === null || child === undefined || child === false) continue;
    element.append(child instanceof Node ? child : readable(String(child)));
  }
}

function fill(element, ...children) {
  element.replaceChildren();
  put(element, children);
}

// Control and direction characters could hide or reorder what is read, and half characters crash browsers:
// they are shown as marks.
function readable(text) {
  return text.replace(/[\u0000-\u0008\u000b-\u001f\u007f-\u009f\u200e\u200f\u202a-\u202e\u2066-\u2069\p{Surrogate}]/gu, "\ufffd");
}

const byId = (id) => document.getElementById(id);
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const asList = (value) => (Array.isArray(value) ? value : []);
const asObject = (value) => (value && typeof value === "object" && !Array.isArray(value) ? value : {});
const number = (value) => Number(value || 0).toLocaleString("en-US");
const plural = (count, name) => `${number(count)} ${name}${count === 1 ? "" : "s"}`;
const money = (usd) => (usd > 0 ? `$${usd < 0.01 ? usd.toPrecision(2) : usd.toFixed(usd < 1 ? 3 : 2)}` : "$0");

// As in all pictures; the page's data brings them.
const colours = {};

function takeColours(given) {
  Object.assign(colours, given);
  const { style } = document.documentElement;
  style.setProperty("--good", colours.placed);
  style.setProperty("--bad", colours.misplaced);
}
