/* What Sphinx's search lacks; it runs between its script and the index. Excerpts: of articles alone, and none from
   disk, where a page cannot read others. Words with one wrong letter. Lectures first if the reader asks. */
"use strict";

if (location.protocol === "file:") DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;

{
  const { htmlToText, _parseQuery } = Search;
  Search.htmlToText = (html, anchor) => {
    const page = new DOMParser().parseFromString(html, "text/html");
    const article = page.querySelector("article.bd-article");
    if (!article) return htmlToText(html, anchor);
    const left = "nav, summary, table, figure, pre, .term-note, .provenance, .page-facts, .lesson-status, .headerlink";
    for (const part of article.querySelectorAll(left)) part.remove();
    return htmlToText(`<div role="main">${article.innerHTML}</div>`, anchor);
  };

  /* Matches the words that differ from one by a letter: another one, one more, or one less. */
  const near = (word) => new RegExp(`^(${word}.|${[...word].map((_, k) => (
    `${word.slice(0, k)}(.?${word.slice(k + 1)}|.${word.slice(k)})`)).join("|")})$`);

  /* A word that no page has, not even as a part of one, becomes the nearest word of most pages. */
  Search._parseQuery = (query) => {
    const parsed = _parseQuery(query);
    const [, words, , shown] = parsed;
    const { terms, titleterms } = Search._index;
    const known = Object.keys({ ...terms, ...titleterms });
    const pages = (word) => [terms[word] ?? []].flat().length;
    for (const word of [...words]) {
      if (word.length < 4 || known.some((one) => one.includes(word))) continue;
      const like = near(word);
      const [nearest = word] = known.filter((one) => like.test(one)).sort((a, b) => pages(b) - pages(a));
      words.delete(word);
      for (const list of [words, shown]) list.add(nearest);
    }
    const asks = /^(can|do|does|how|is|should|what|when|where|which|who|why)\s|\?/i.test(query.trim());
    Scorer.score = ([name, , , , score]) => score + (asks && /\/(lecture|motion)$/.test(name) ? 100 : 0);
    return parsed;
  };
}
