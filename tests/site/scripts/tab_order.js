() => [...document.querySelectorAll("*")].filter(element => element.tabIndex > 0)
  .map(element => element.outerHTML.slice(0, 100))
