// What the page says, in the languages it speaks. Elements name their text: data-text (content), data-label (name for
// screen readers), data-hint (placeholder).
const kTexts = {
  en: {
    talk_tab: 'Talk', engineer_tab: 'Engineer', views: 'views',
    connecting: 'connecting', connected: 'connected', away: 'the hub is away; trying again',
    refused: 'the hub asks for its token: open the address it prints',
    face: 'the face', no_face: 'No face: {why}. Trying again.', waiting_face: 'Waiting for the face',
    unknown_why: 'the connection was lost',
    sound_on: 'Turn sound on', sound_off: 'Turn sound off', no_voice: 'No sound: {why}. Trying again.',
    sound_blocked: 'The browser keeps the sound off until you press “Turn sound on” or send something.',
    sound_twice: 'The voice also sounds where it runs ({sink}); so sound is off here.',
    subtitles: 'Subtitles', full_screen: 'Full screen',
    welcome: 'Galatea is here. Ask something.',
    log: 'what both said', you: 'You', agent: 'Galatea', interrupted: 'interrupted',
    hint_chat: 'Ask something', hint_ear: 'Say something to it, typed', hint_voice: 'What shall it say?', hint_none: 'Nobody listens',
    hint_no_chat: 'Nobody answers',
    way_chat: 'It answers (module CHAT).', way_chat_silent: 'It answers in writing only: the voice (module SSM) is not there.',
    way_no_chat: 'Nobody answers: the module CHAT is not there.', way_coming: 'The agent is still starting.', hint_coming: 'Ask something', way_ear: 'What you type is heard by its ear.',
    way_voice: 'Nobody answers here: the voice says what you type.', way_none: 'Neither ear nor voice is there.',
    dialog_over: 'The dialogue is over.', dialog_failed: 'The dialogue ended by an error; where the agent was started it is told.',
    dialog_again: 'Start the dialogue again', way_dialog: 'The dialogue is over: nobody listens.', hint_dialog: 'Nobody listens',
    voice_away: 'The voice (module SSM) is not there: answers can only be read.', voice_failed: 'The voice could not say that: {why}',
    starting: 'The agent is still starting; what you typed is kept …',
    module_away: 'its module is not running',
    held_full: 'The agent is still starting and no more lines are kept; send this one again when it is there.',
    message: 'your message', send: 'Send', stop: 'Stop', thinking: 'thinking …', hearing: 'listening to you …',
    model_error: 'The model did not answer: {why}',
    mic: 'Microphone', mic_off: 'Microphone off.', mic_asking: 'Asking for the microphone …',
    mic_starting: 'The ear is getting ready; what you say is kept …',
    mic_listening: 'Listening: say something.', mic_speech: 'Somebody speaks …', mic_silent: 'The microphone is silent: is it the right one, is it muted?',
    mic_no_ear: 'No microphone: there is no ear (module SRM).', mic_typed_ear: 'No microphone: the ear here takes typed text only (srm_stub).',
    mic_none: 'No microphone: this browser gives pages none, or only over https or on this machine.',
    mic_denied: 'The browser was told not to give the microphone.', mic_missing: 'This computer has no microphone.',
    not_understood: 'not understood: {what}', deaf: 'The ear does not listen.',
    settings: 'Face and voice', pick_face: 'Face', pick_voice: 'Voice', pick_language: 'Language',
    pick_emotion: 'Emotion', pick_strength: 'Strength', automatic: 'automatic', typed_only: '{language} (typed only)',
    NEUTRAL: 'neutral', HAPPY: 'happy', SAD: 'sad', ANGRY: 'angry', SURPRISED: 'surprised', DISGUSTED: 'disgusted', FEARED: 'afraid',
  },
  ja: {
    talk_tab: '会話', engineer_tab: '技術', views: '表示',
    connecting: '接続中', connected: '接続済み', away: 'ハブがいません。再接続しています',
    refused: 'トークンが必要です。ハブが表示したアドレスを開いてください',
    face: '顔', no_face: '顔が見えません（{why}）。再試行しています。', waiting_face: '顔を待っています',
    unknown_why: '接続が切れました',
    sound_on: '音を出す', sound_off: '音を消す', no_voice: '音がありません（{why}）。再試行しています。',
    sound_blocked: '「音を出す」を押すか、何か送ると、ブラウザーが音を出します。',
    sound_twice: '声は動作中の機械からも出ています（{sink}）。ここでは音を消しています。',
    subtitles: '字幕', full_screen: '全画面',
    welcome: 'ガラテアです。何か聞いてください。',
    log: '会話の記録', you: 'あなた', agent: 'ガラテア', interrupted: '中断',
    hint_chat: '何か聞いてください', hint_ear: '文字で話しかけてください', hint_voice: '何と言わせますか', hint_none: '聞き手がいません',
    hint_no_chat: '答える相手がいません',
    way_chat_silent: '文字だけで答えます。声（モジュール SSM）がありません。',
    way_no_chat: '答える相手がいません。モジュール CHAT がありません。', way_coming: 'まだ起動中です。', hint_coming: '何か聞いてください',
    way_chat: '答えます（モジュール CHAT）。', way_ear: '入力した文は耳に届きます。',
    way_voice: '答える相手はいません。入力した文をそのまま話します。', way_none: '耳も声もありません。',
    dialog_over: '対話が終わりました。', dialog_failed: '対話がエラーで終わりました。起動した端末に理由があります。',
    dialog_again: '対話をもう一度始める', way_dialog: '対話が終わり、聞き手がいません。', hint_dialog: '聞き手がいません',
    voice_away: '声（モジュール SSM）がありません。答えは文字だけです。', voice_failed: '声が話せませんでした：{why}',
    starting: 'まだ起動中です。入力した文は後で届けます…',
    module_away: 'モジュールが動いていません',
    held_full: 'まだ起動中で、これ以上は保存できません。起動後にもう一度送ってください。',
    message: 'メッセージ', send: '送る', stop: '止める', thinking: '考え中…', hearing: '聞いています…',
    model_error: 'モデルが答えませんでした：{why}',
    mic: 'マイク', mic_off: 'マイクはオフです。', mic_asking: 'マイクの許可を求めています…',
    mic_starting: '耳を準備しています。話したことは取っておきます…',
    mic_listening: '聞いています。話してください。', mic_speech: '声が聞こえます…', mic_silent: 'マイクから音が来ません。正しいマイクですか、消音ですか。',
    mic_no_ear: 'マイクは使えません：耳（モジュール SRM）がありません。', mic_typed_ear: 'マイクは使えません：この耳は文字だけです（srm_stub）。',
    mic_none: 'マイクは使えません：このブラウザーではページに渡されません（https か同じ機械でのみ）。',
    mic_denied: 'ブラウザーでマイクが許可されていません。', mic_missing: 'この機械にはマイクがありません。',
    not_understood: 'わかりませんでした：{what}', deaf: '耳は今聞いていません。',
    settings: '顔と声', pick_face: '顔', pick_voice: '声', pick_language: '言語',
    pick_emotion: '感情', pick_strength: '強さ', automatic: '自動', typed_only: '{language}（文字のみ）',
    NEUTRAL: 'ふつう', HAPPY: '喜び', SAD: '悲しみ', ANGRY: '怒り', SURPRISED: '驚き', DISGUSTED: '嫌悪', FEARED: '恐れ',
  },
};

let language = navigator.language.startsWith('ja') ? 'ja' : 'en';

export function text(key, values = {}) {
  return (kTexts[language][key] ?? key).replace(/\{(\w+)\}/g, (_, name) => values[name] ?? '');
}

export function useLanguage(wanted) {
  language = wanted in kTexts ? wanted : navigator.language.startsWith('ja') ? 'ja' : 'en';
  document.documentElement.lang = language;
  for (const node of document.querySelectorAll('[data-text]')) node.textContent = text(node.dataset.text);
  for (const node of document.querySelectorAll('[data-label]')) node.setAttribute('aria-label', text(node.dataset.label));
  for (const node of document.querySelectorAll('[data-hint]')) node.placeholder = text(node.dataset.hint);
}

// Shows a text that changes with the language.
export function put(node, key, values) {
  if (values) {
    delete node.dataset.text;
    node.textContent = text(key, values);
  } else {
    node.dataset.text = key;
    node.textContent = text(key);
  }
}

export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  Object.assign(made, attributes);
  made.append(...children);
  return made;
}
