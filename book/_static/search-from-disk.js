/* Browsers let a page from disk read no other file, so results show there without their excerpts. */
"use strict";

if (location.protocol === "file:") DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;
