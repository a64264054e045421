() => [
  ...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource"),
].map(entry => ({
  name: new URL(entry.name).pathname,
  bytes: entry.encodedBodySize,
  blocking: entry.renderBlockingStatus === "blocking",
}))
