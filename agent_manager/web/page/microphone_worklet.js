// Samples as 16 bit numbers, a tenth of a second at a time.
'use strict';

class Samples extends AudioWorkletProcessor {
  constructor() {
    super();
    this.piece = new Int16Array(sampleRate / 10);
    this.filled = 0;
  }
  process([[channel]]) {
    for (const sample of channel || []) {
      this.piece[this.filled++] = Math.max(-1, Math.min(1, sample)) * 32767;
      if (this.filled < this.piece.length) continue;
      this.port.postMessage(this.piece.slice().buffer);
      this.filled = 0;
    }
    return true;
  }
}
registerProcessor('samples', Samples);
