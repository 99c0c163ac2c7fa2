// Run in the hub's page by page_skew.py: has the agent say some sentences, and notes when each picture was put on the
// canvas and what the page's sound was, sample by sample. The result is window.skew, texts and numbers.
(async () => {
  const {hub, clock, delay, face, voice} = galatea;
  const kSentences = ['Papa Bob may pay.', 'My baby bubbles up.', 'Peter Piper picked a peck.', 'Mama may bake a pie.'];
  const kLoud = 600, kRate = 16000;
  const result = {pictures: [], sent: [], heard: [], offsets: [], clicks: [], delay: 0, said: 0};
  const context = voice.context;
  await voice.allow();
  await context.audioWorklet.addModule('microphone_worklet.js');

  // What is heard: a worklet beside the loudspeaker. A click of its own at a known time says which sample was when.
  const tap = new AudioWorkletNode(context, 'samples', {numberOfOutputs: 0});
  const running = context.createConstantSource();
  running.offset.value = 0;
  running.connect(tap);
  running.start();
  voice.gain.connect(tap);
  const samples = [];
  tap.port.onmessage = ({data}) => samples.push(...new Int16Array(data));
  const click = context.createBufferSource();
  click.buffer = context.createBuffer(1, 1, kRate);
  click.buffer.getChannelData(0)[0] = 1;
  click.connect(tap);
  const click_at = context.currentTime + 0.5;
  click.start(click_at);
  await new Promise(done => setTimeout(done, 1500));
  const click_sample = samples.findIndex(sample => sample > 30000);

  // When the voice's samples are to be heard, and what was drawn when.
  const take = voice.take.bind(voice);
  voice.take = piece => {
    if (piece.kind === 2) result.sent.push([piece.at, new Int16Array(piece.bytes.slice(0))]);
    take(piece);
  };
  face.onDraw = at => result.pictures.push([clock.toPage(at), performance.now()]);
  const stamps = setInterval(() => {
    const {contextTime, performanceTime} = context.getOutputTimestamp();
    if (contextTime) result.offsets.push(performanceTime - contextTime * 1000);
  }, 50);
  const idle = () => new Promise(done => {
    const look = setInterval(async () => {
      if ((await hub.ask('to @SSM inq Speak.stat')) === 'IDLE') clearInterval(look), done();
    }, 100);
  });
  const begins = [];  // page's time at which each utterance's first loud sample is due
  for (let i = 0; i < window.kUtterances; ++i) {
    const from = result.sent.length;
    await hub.ask(`to @AM-MCL set Speak = ${kSentences[i % kSentences.length]}`);
    await idle();
    await new Promise(done => setTimeout(done, 900));
    for (const [at, piece] of result.sent.slice(from)) {
      const first = piece.findIndex(sample => Math.abs(sample) > kLoud);
      if (first < 0) continue;
      begins.push(clock.toPage(at + first * 1000 / kRate));
      break;
    }
  }
  await new Promise(done => setTimeout(done, 500));
  clearInterval(stamps);

  const median = numbers => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
  const offset = median(result.offsets);
  // First loud samples after silence, as they left for the loudspeaker.
  let quiet = 0;
  const onsets = [];
  for (let i = click_sample + 10; i < samples.length; ++i) {
    if (Math.abs(samples[i]) <= kLoud) { ++quiet; continue; }
    if (quiet > kRate * 0.6) onsets.push((click_at + (i - click_sample) / kRate) * 1000 + offset);
    quiet = 0;
  }
  window.skew = {
    begins, onsets, pictures: result.pictures, delay: delay.ms, click: click_sample,
    per_second: result.pictures.length * 1000 / (result.pictures.at(-1)[1] - result.pictures[0][1]),
  };
})().catch(error => { window.skew = {error: String(error.stack)}; });
