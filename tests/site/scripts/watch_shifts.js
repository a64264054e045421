window.shifts = [];
const note = entries => {
  for (const { value, sources } of entries) {
    shifts.push([value, sources.map(source => source.node?.outerHTML?.slice(0, 80))]);
  }
};
const observer = new PerformanceObserver(list => note(list.getEntries()));
observer.observe({ type: "layout-shift", buffered: true });
window.allShifts = () => {
  note(observer.takeRecords()); // those of which it has not been told yet
  return shifts;
};
