// Errors are collected from the first line on, so that a test can read them.
const troubles = [];
window.addEventListener("error", (event) => troubles.push(String(event.message)));
window.addEventListener("unhandledrejection", (event) => troubles.push(String(event.reason)));
document.addEventListener("securitypolicyviolation", (event) => troubles.push("policy: " + event.violatedDirective));
{
  const report = console.error.bind(console);
  console.error = (...parts) => {
    troubles.push(parts.map(String).join(" "));
    report(...parts);
  };
}
