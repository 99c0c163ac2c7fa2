#include "bench/speech_material.h"

#include <cmath>
#include <ctime>

namespace speech_bench {

const std::vector<std::string>& Phrases() {
  static const std::vector<std::string> phrases = {
      "yes please",           "no thank you",     "turn on the light",    "turn off the light",
      "open the window",      "close the window", "what time is it",      "tell me a story",
      "good morning",         "good night",       "call my mother",       "send a message",
      "play some music",      "stop the music",   "where is the station", "i want two apples",
      "three pounds of fish", "how much is it",   "that is all",          "start again",
      "go to the next page",  "read it to me",    "what is the weather",  "book a table for four",
      "change the channel",   "make it louder",   "who are you",          "see you tomorrow",
      "help me please",       "cancel the order"};
  return phrases;
}

const std::vector<std::string>& OtherSentences() {
  static const std::vector<std::string> sentences = {"the weather was cold in december",
                                                     "my brother lives in another country",
                                                     "seven people came to the party",
                                                     "she bought a large umbrella",
                                                     "computers are getting faster every year",
                                                     "we should leave before noon",
                                                     "he never drinks coffee in the evening",
                                                     "the cat slept under the chair",
                                                     "this road leads to the village",
                                                     "they were waiting for the bus",
                                                     "i have forgotten my password",
                                                     "put the books on the shelf",
                                                     "the train was late again",
                                                     "his answer surprised everybody",
                                                     "fresh bread smells wonderful",
                                                     "you can see the mountains from here",
                                                     "nobody knew what to do",
                                                     "the children are playing in the garden",
                                                     "our teacher speaks three languages",
                                                     "please sign on the dotted line",
                                                     "i would rather stay at home",
                                                     "the soup needs more salt",
                                                     "her grandfather was a sailor",
                                                     "it rained during the whole concert",
                                                     "the museum opens at ten",
                                                     "we ran out of milk",
                                                     "this shirt is too small for me",
                                                     "did you hear that noise",
                                                     "the old bridge was closed for repairs",
                                                     "my favourite colour is green",
                                                     "the doctor will be back soon",
                                                     "they painted the house yellow",
                                                     "a bird built its nest there",
                                                     "the price has doubled since then",
                                                     "i met her on the way to school",
                                                     "water boils at one hundred degrees",
                                                     "turn left at the second corner",
                                                     "open your eyes slowly",
                                                     "what a beautiful day",
                                                     "call it whatever you like",
                                                     "the music was far too loud",
                                                     "send him to the other office",
                                                     "where have you put my glasses",
                                                     "stop worrying about the money",
                                                     "two of them were missing",
                                                     "how did you find us",
                                                     "the light was already red",
                                                     "time is running out",
                                                     "tell your sister the truth",
                                                     "good ideas are rare"};
  return sentences;
}

const std::vector<SmallGrammar>& SmallGrammars() {
  static const std::vector<SmallGrammar> grammars = {
      {{"yes", "no", "maybe"},
       {"hello", "banana", "seven", "what time is it", "i do not know", "perhaps", "never", "guess",
        "snow", "next"}},
      {{"red", "green", "blue", "yellow", "black"},
       {"orange", "bread", "window", "two", "i like purple", "nothing at all", "fellow",
        "show me the list", "back", "grey"}},
      {{"one", "two", "three", "four", "five", "six"},
       {"seven", "nine", "hundred", "fish", "a dozen", "i want more", "tea", "open the door",
        "free", "door"}},
      {{"stop", "go", "left", "right", "turn around"},
       {"start", "slow down", "jump", "light", "top", "what is this", "come back here", "up",
        "around the house", "music"}},
      {{"tea please", "a cup of coffee", "water", "orange juice", "nothing thanks"},
       {"beer", "a glass of wine", "where is the station", "something else", "milk", "later please",
        "coffee table", "apple pie", "thank you", "quarter"}},
      {{"call anna", "call peter", "hang up", "play music", "volume up"},
       {"call the police", "send a message", "hello", "turn on the light", "stop music",
        "how are you", "volume down", "read my mail", "cancel", "anna"}},
      {{"open", "close", "lock", "unlock"},
       {"hope", "clothes", "look", "hello there", "what did you say", "paint it", "never mind",
        "clock", "good evening", "fifteen"}},
      {{"monday", "tuesday", "wednesday", "thursday", "friday"},
       {"saturday", "sunday", "someday", "tomorrow", "next week", "february", "not today",
        "i have no idea", "thirsty", "where are you"}},
      {{"small", "medium", "large"},
       {"tall", "huge", "the biggest one", "mall", "march", "pizza", "a little bit", "many",
        "whatever", "excuse me"}},
      {{"first page", "last page", "next", "previous", "exit"},
       {"second page", "text", "exercise", "the end", "please wait", "go home", "fist", "nest",
        "print it", "one more time"}},
      {{"london", "paris", "berlin", "madrid", "rome"},
       {"boston", "vienna", "room", "new york", "i am hungry", "how far is it", "merlin", "parents",
        "tokyo", "good bye"}},
      {{"pizza", "salad", "soup of the day", "fish and chips", "the bill please"},
       {"pasta", "steak", "soap", "ship", "a table for two", "is it ready", "ballad", "piece",
        "chicken and rice", "hurry up"}}};
  return grammars;
}

const std::vector<std::string>& JapanesePhrases() {
  static const std::vector<std::string> phrases = {"おはよう ございます",
                                                   "こんにちは",
                                                   "こんばんは",
                                                   "ありがとう ございます",
                                                   "すみません",
                                                   "おねがい します",
                                                   "はい そうです",
                                                   "いいえ ちがいます",
                                                   "もう いちど いって ください",
                                                   "わかりました",
                                                   "わかりません",
                                                   "すこし まって ください",
                                                   "いま なんじ ですか",
                                                   "てんき は どう ですか",
                                                   "とうきょう まで いきます",
                                                   "りんご を ふたつ ください",
                                                   "いくら ですか",
                                                   "でんわ を かけて ください",
                                                   "やめて ください",
                                                   "さようなら"};
  return phrases;
}

Speech Say(ssm::SpeechEngine& engine, const std::string& text, const std::string& voice) {
  const std::atomic<bool> never{false};
  auto plan = engine.Plan({{.text = text, .voice = voice}}, never);
  if (!plan) return {};
  ssm::SampleBuffer buffer(ssm::ToFrames(vm::TotalDuration(plan->phonemes)));
  static_cast<void>(engine.Render(*plan, buffer));
  return {std::move(*plan), {buffer.Ready().begin(), buffer.Ready().end()}};
}

Samples WithNoise(Samples samples, double ratio_db) {
  double power = 0;
  for (const std::int16_t s : samples) power += static_cast<double>(s) * s;
  const double rms =
      std::sqrt(power / static_cast<double>(samples.size()) / std::pow(10, ratio_db / 10));
  std::uint32_t state = 1;
  for (std::int16_t& s : samples) {
    state = state * 1664525u + 1013904223u;
    const double noise = (static_cast<double>(state >> 8) / (1 << 23) - 1) * rms * std::sqrt(3.0);
    s = static_cast<std::int16_t>(std::lround(std::fmax(-32768, std::fmin(32767, s + noise))));
  }
  return samples;
}

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double SoundSeconds(const Samples& samples) { return static_cast<double>(samples.size()) / 16000; }

}  // namespace speech_bench
