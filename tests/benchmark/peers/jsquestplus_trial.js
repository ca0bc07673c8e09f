// Measures a trial of QUEST+ in jsQuestPlus, which keeps a table of stimuli times parameters. Arguments: the
// numbers of stimuli, thresholds, slopes and lapse rates of the grid. Prints "version median slowest", times
// in milliseconds.
const Q = require('jsquest-plus');
const [stimuli, thresholds, slopes, lapses] = process.argv.slice(2).map(Number);
const grid = (a, b, n) => Array.from({length: n}, (_, i) => a + (b - a) * i / (n - 1));
const no = (x, t, s, g, l) => Q.weibull(x, t, s, g, l);
const q = new Q({
  psych_func: [no, (...a) => 1 - no(...a)],
  stim_samples: [grid(-40, 0, stimuli)],
  psych_samples: [grid(-40, 0, thresholds), grid(.5, 5, slopes), [.5], grid(.005, .04, lapses)]
});
const times = [];
for (let i = 0; i < 8; ++i) {
  const start = performance.now(), stimulus = q.getStimParams();
  q.update(stimulus, i % 4 == 3 ? 0 : 1);
  times.push(performance.now() - start);
}
times.sort((a, b) => a - b);
console.log('2', (times[3] + times[4]) / 2, times[7]);
