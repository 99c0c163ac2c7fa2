// What slots are for, by their names: the first row that fits. The engineer's view shows them so.
export const kGroups = [
  ['speaking', /^(Speak|Text|Say|Reply|Heard|Input\.text|AutoPlay|Speaker|Rate|Pitch|Volume|Emotion|Sound\.to|Sink|SpeechFile|ParsedText|Alpha|Postfilter)/],
  ['listening', /^(Listen|Input|Result|Grammar|NoMatch|NoInput|BargeIn|Spot|Agent$|Agent\.|Mouth\.sounds)/],
  ['language model', /^(Model|Persona|Tools|History|Language|Apology|Talk|Busy)/],
  ['mouth shapes', /^(Save)?MouthShape/],
  ['lips', /^(LipSync|Mouth|Offset|Phoneme)/],
  ['expression', /^(FaceExp|AU|Face|Mood|Life|Asymmetry|Blush|Tear|AutoEmotion)/],
  ['head and eyes', /^(Head|Rot|Eye|Gaze|Look|Blink|Pupil|Auto(Move|Gaze)|Neck)/],
  ['looks', /^(Mask|NowMask|Background|NowBackground|View|Light|Camera|Agent|Window|Simulation|Hair)/],
  ['films and files', /^(Record|Save|Load|Capture|Frame|Pros|Play)/],
  ['the hub', /^(Name|Subscribe|Flow|Start|Stop|Restart|Module|Process|Macro|Limit|Refused|Agents|Reload|Peers)/],
  ['housekeeping', /^(Slots|Error|Err|Log|Run|ModuleVersion|ProtocolVersion|Clock|Wait)/],
];
export const kOther = 'other';

export function groupOf(slot) {
  const found = kGroups.find(([, pattern]) => pattern.test(slot));
  return found ? found[0] : kOther;
}
