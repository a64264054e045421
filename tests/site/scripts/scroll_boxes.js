() => [...document.querySelectorAll("article *")].filter(element => {
  const { overflowX, visibility } = getComputedStyle(element);
  return /auto|scroll/.test(overflowX) && element.scrollWidth > element.clientWidth
    && element.clientWidth && visibility === "visible";
}).filter(element => element.tabIndex !== 0
  || !(element.ariaLabel || element.querySelector(":scope > figcaption, :scope > caption")),
).map(element => `not reached, or without a name: ${element.outerHTML.slice(0, 100)}`)
