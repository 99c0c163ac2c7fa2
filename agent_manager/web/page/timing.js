// When the text went to the voice, its phonemes came, the sound and the face began and ended: the last utterances.
const kMostUtterances = 6;

export class Timing {
  constructor(chart) {
    this.chart = chart;
    this.utterances = [];
    this.draw();
  }

  measure({time, from, to, line}) {
    let found;
    const now = this.utterances[this.utterances.length - 1];
    if (to === 'SSM' && (found = line.match(/set(?:#\S+)? Text = (.*)/))) {
      this.utterances.push({words: found[1], text: time});
      if (this.utterances.length > kMostUtterances) this.utterances.shift();
    } else if (now && from === 'SSM' && /rep(?:#\S+)? Text\.pho/.test(line)) {
      now.phonemes ??= time;
    } else if (now && from === 'SSM' && /rep(?:#\S+)? Speak\.stat = SPEAKING/.test(line)) {
      now.sound ??= time;
    } else if (now && from === 'SSM' && /rep(?:#\S+)? Speak\.stat = IDLE/.test(line) && now.sound) {
      now.silent ??= time;
    } else if (now && from === 'FSM' && /rep(?:#\S+)? Speak\.stat = SPEAKING/.test(line)) {
      now.frames ??= time;
    } else if (now && from === 'FSM' && /rep(?:#\S+)? Speak\.stat = IDLE/.test(line) && now.frames) {
      now.still ??= time;
    } else {
      return;
    }
    this.draw();
  }

  draw() {
    const width = this.chart.clientWidth || 600, row = 24, left = 130;
    const longest = Math.max(500, ...this.utterances.map(
        u => Math.max(...['phonemes', 'sound', 'silent', 'frames', 'still'].map(k => u[k] || u.text)) - u.text));
    const x = ms => left + ms / longest * (width - left - 60);
    const parts = [];
    const bar = (u, a, b, kind, y, high) => {
      if (u[a] === undefined || u[b] === undefined) return;
      const from = u[a] - u.text, till = u[b] - u.text;
      parts.push(`<rect class="bar-${kind}" x="${x(from)}" y="${y}" height="${high}" ` +
                 `width="${Math.max(1, x(till) - x(from))}"><title>${kind}: ${from.toFixed(1)} to ` +
                 `${till.toFixed(1)} ms</title></rect>`);
    };
    this.utterances.forEach((u, i) => {
      const y = 6 + i * row;
      const words = u.words.length > 18 ? u.words.slice(0, 17) + '…' : u.words;
      parts.push(`<text x="4" y="${y + 12}">${words.replace(/[<&]/g, '')}</text>`);
      bar(u, 'text', 'phonemes', 'text', y, 16);
      bar(u, 'phonemes', 'sound', 'wait', y, 16);
      bar(u, 'sound', 'silent', 'sound', y, 8);
      bar(u, 'frames', 'still', 'frames', y + 8, 8);
      const end = Math.max(u.silent || 0, u.still || 0);
      if (end) parts.push(`<text x="${x(end - u.text) + 4}" y="${y + 12}">${Math.round(end - u.text)} ms</text>`);
    });
    if (!parts.length)
      parts.push(`<text x="8" y="20">Let it say something, and here is how it went.</text>`);
    this.chart.innerHTML = parts.join('');
  }
}
