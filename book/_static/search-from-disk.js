/* What Sphinx's search lacks. Excerpts of results: none from disk, where a page cannot read other files, and
   of articles alone, without menus, tables and lines of provenance. Words with one wrong letter. Lectures
   come first if the reader asks a question. It runs between Sphinx's script and the index (`postprocess.py`). */
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

  /* Whether two words differ by one letter: another one, one more, or one less. */
  function near(word, other) {
    let same = 0;
    while (same < word.length && word[same] === other[same]) same++;
    const rest = (skip, skipOther) => word.slice(same + skip) === other.slice(same + skipOther);
    return rest(1, 1) || rest(1, 0) || rest(0, 1);
  }

  /* A word that no page has, not even as a part of one, becomes the nearest word of most pages. */
  Search._parseQuery = (query) => {
    const parsed = _parseQuery(query);
    const [, words, , shown] = parsed;
    const { terms, titleterms } = Search._index;
    const known = Object.keys({ ...terms, ...titleterms });
    const pages = (word) => [terms[word] ?? []].flat().length;
    for (const word of [...words].filter((one) => one.length > 3)) {
      if (known.some((one) => one.includes(word))) continue;
      const [nearest] = known.filter((one) => near(one, word)).sort((a, b) => pages(b) - pages(a));
      if (!nearest) continue;
      words.delete(word);
      for (const list of [words, shown]) list.add(nearest);
    }
    const asks = /^(can|do|does|how|is|should|what|when|where|which|who|why)\s|\?/i.test(query.trim());
    const lecture = ([name]) => asks && /\/(lecture|motion)$/.test(name);
    Scorer.score = (result) => result[4] + (lecture(result) ? 100 : 0);
    return parsed;
  };
}
