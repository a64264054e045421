() => new Set([...document.querySelectorAll(
  "article :is(a[href], button, input, select, textarea, summary, [tabindex])"
)].filter((one) =>
  one.tabIndex >= 0 && !one.disabled && one.checkVisibility({ visibilityProperty: true })
  // Radio buttons of one name are one stop: the arrow keys choose among them.
).map((one) => one.type === "radio" ? one.name : one)).size
