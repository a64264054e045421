/* Excerpts of Sphinx's search: none from disk, where a page cannot read other files, and of articles
   alone, without menus, tables and lines of provenance. It runs between Sphinx's script and the index
   (`postprocess.py`). */
"use strict";

if (location.protocol === "file:") DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;

{
  const { htmlToText } = Search;
  Search.htmlToText = (html, anchor) => {
    const page = new DOMParser().parseFromString(html, "text/html");
    const article = page.querySelector("article.bd-article");
    if (!article) return htmlToText(html, anchor);
    const left = "nav, summary, table, figure, pre, .term-note, .provenance, .page-facts, .lesson-status, .headerlink";
    for (const part of article.querySelectorAll(left)) part.remove();
    return htmlToText(`<div role="main">${article.innerHTML}</div>`, anchor);
  };
}
