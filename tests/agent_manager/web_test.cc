// The hub's page: what it shows to those who may see it, and what others get.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/process.h"

namespace {

using support::Process;
using support::SocketClient;

const std::string kHub = GALATEA_BIN_DIR "/agent_manager";
const std::string kToken = "sixteen-bytes-or-more";

class WebTest : public testing::Test {
 protected:
  WebTest() {
    const std::string token = folder_ / "token", config = folder_ / "config.json";
    std::ofstream(token) << kToken << "\n";
    chmod(token.c_str(), 0600);
    std::ofstream(config) << "{\"listen\": [{\"at\": \"unix:" << folder_ / "hub"
                          << "\", \"role\": \"owner\"}], \"web\": {\"at\": \"tcp:127.0.0.1:0\", "
                             "\"role\": \"owner\", \"token_file\": \""
                          << token
                          << "\"}, \"modules\": [{\"name\": \"FSM\", \"command\": [\"python3\", \""
                          << GALATEA_SOURCE_DIR
        "/tests/agent_manager/fake_face.py\"]}, {\"name\": \"SRM\", \"command\": [\"python3\", \""
                          << GALATEA_SOURCE_DIR
        "/tests/agent_manager/fake_ear.py\"]}, {\"name\": \"SSM\", \"command\": [\"python3\", \""
                          << GALATEA_SOURCE_DIR "/tests/agent_manager/fake_voice.py\"]}]}";
    hub_ = std::make_unique<Process>(std::vector<std::string>{kHub, "--config", config});
    EXPECT_TRUE(hub_->ExpectError("/?token=")) << hub_->ErrorText();
    const std::string text = hub_->ErrorText();
    host_ = text.substr(text.find("http://") + 7);
    host_ = host_.substr(0, host_.find('/'));
    port_ = static_cast<unsigned short>(std::atoi(host_.c_str() + host_.find(':') + 1));
  }
  /// Says a request with these header lines and returns the open connection.
  std::unique_ptr<SocketClient> Open(const std::string& target, const std::string& headers) {
    auto client = SocketClient::Tcp(port_);
    client->Write("GET " + target + " HTTP/1.1\r\n" + headers + "\r\n");
    return client;
  }
  std::string Host() const { return "Host: " + host_ + "\r\n"; }
  std::string CookieName() const { return "galatea_token_" + std::to_string(port_); }
  std::string Cookie() const { return "Cookie: other=1; " + CookieName() + "=" + kToken + "\r\n"; }
  std::string StatusOf(const std::string& target, const std::string& headers) {
    const auto line = Open(target, headers)->ReadLine();
    return line && line->size() > 12 ? line->substr(9, 3) : "nothing";
  }
  static std::string Socket(const std::string& origin) {
    return "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n" +
           (origin.empty() ? "" : "Origin: " + origin + "\r\n");
  }
  /// A text frame; the mask is zero, which leaves the text as it is.
  static std::string Frame(const std::string& text) {
    std::string frame = "\x81";
    if (text.size() < 126) {
      frame += static_cast<char>(0x80 | text.size());
    } else {
      const bool wide = text.size() > 0xffff;
      frame += static_cast<char>(0x80 | (wide ? 127 : 126));
      for (int i = wide ? 7 : 1; i >= 0; --i)
        frame += static_cast<char>(text.size() >> (8 * i) & 0xff);
    }
    return frame + std::string(4, '\0') + text;
  }

  support::TempDir folder_;
  std::unique_ptr<Process> hub_;
  std::string host_;
  unsigned short port_ = 0;
};

TEST_F(WebTest, OnlyTheTokenOpensThePage) {
  EXPECT_EQ(StatusOf("/", Host()), "401");
  EXPECT_EQ(StatusOf("/?token=wrong", Host()), "401");
  EXPECT_EQ(StatusOf("/", Host() + "Cookie: " + CookieName() + "=\r\n"), "401");
  EXPECT_EQ(StatusOf("/ws", Host() + Socket("http://" + host_)), "401");
  EXPECT_EQ(StatusOf("/", Host() + "Authorization: bearer " + kToken + "\r\n"), "200");
  EXPECT_EQ(StatusOf("/", "Host: LOCALHOST:" + std::to_string(port_) + "\r\n" + Cookie()), "200");
  EXPECT_TRUE(hub_->ExpectError("web page: refused a request without the token from 127.0.0.1"));
  const auto first = Open("/?token=" + kToken, Host());
  EXPECT_TRUE(first->Expect("303 See Other"));
  EXPECT_TRUE(first->Expect("Location: /"));
  EXPECT_TRUE(first->Expect("HttpOnly; SameSite=Strict"));
  const auto page = Open("/", Host() + Cookie());
  EXPECT_TRUE(page->Expect("200 OK"));
  EXPECT_TRUE(page->Expect("Content-Security-Policy: default-src 'self'"));
  EXPECT_TRUE(page->Expect("<title>Galatea</title>"));
}

TEST_F(WebTest, NoPathLeadsOutOfThePage) {
  for (const char* path :
       {"/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/..\\etc\\passwd",
        "/app.js/../../etc/passwd", "/page/app.js", "/token"}) {
    EXPECT_EQ(StatusOf(path, Host() + Cookie()), "404") << path;
  }
  EXPECT_EQ(StatusOf("/app.js", Host() + Cookie()), "200");
}

TEST_F(WebTest, OtherSitesAndHostsAreRefused) {
  EXPECT_EQ(StatusOf("/", "Host: evil.example\r\n" + Cookie()), "421");
  EXPECT_EQ(StatusOf("/ws", Host() + Cookie() + Socket("http://evil.example")), "403");
  EXPECT_TRUE(hub_->ExpectError("a page of the site http://evil.example"));
  EXPECT_EQ(StatusOf("/ws", Host() + Cookie() + Socket("http://" + host_)), "101");
}

TEST_F(WebTest, OversizedRequestsAndMessagesAreRefused) {
  EXPECT_EQ(StatusOf("/", Host() + Cookie() + "X-Long: " + std::string(20000, 'x') + "\r\n"),
            "413");
  const auto socket = Open("/ws", Host() + Cookie() + Socket(""));
  ASSERT_TRUE(socket->Expect("101 Switching"));
  socket->Write(Frame("to @AM set#1 Name = LOUD"));
  socket->Write(Frame(std::string(70000, 'x')));
  EXPECT_TRUE(hub_->ExpectError("web page: refused a message over 65536 bytes"));
  // A length no memory has.
  const auto other = Open("/ws", Host() + Cookie() + Socket(""));
  ASSERT_TRUE(other->Expect("101 Switching"));
  other->Write(std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14));
  other->ReadAll();
  EXPECT_TRUE(other->AtEnd());
  hub_->WriteLine("inq#1 Modules");
  EXPECT_TRUE(hub_->Expect("rep#1 Modules = "));
}

TEST_F(WebTest, AWebSocketIsAPeerThatCanBeAModule) {
  const auto socket = Open("/ws", Host() + Cookie() + Socket("http://" + host_));
  ASSERT_TRUE(socket->Expect("101 Switching"));
  socket->Write(Frame("to @AM set Name = PAGE"));
  socket->Write(Frame("from @FSM to @CONSOLE tell hello\nto @CONSOLE tell again"));
  EXPECT_TRUE(hub_->Expect("From @PAGE tell hello")) << hub_->Seen();
  EXPECT_TRUE(hub_->Expect("From @PAGE tell again"));
  // As a module it is asked for its clock: the hub's first tag for it.
  socket->Write(Frame("rep Run = LIVE"));
  EXPECT_TRUE(hub_->Expect("From @PAGE rep Run = LIVE"));
  socket->Write(Frame("\x01\x02 nonsense"));
  socket->CloseInput();
  hub_->WriteLine("to @FSM inq#1 Run");
  EXPECT_TRUE(hub_->Expect("From @FSM rep#1 Run = LIVE"));
}

TEST_F(WebTest, TheFaceComesAsPicturesWhileSomebodyLooks) {
  {
    const auto video = Open("/face.mjpg", Host() + Cookie());
    ASSERT_TRUE(video->Expect("200 OK")) << hub_->ErrorText();
    EXPECT_TRUE(video->Expect("multipart/x-mixed-replace; boundary=picture"));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(video->Expect("Content-Type: image/jpeg")) << i;
  }
  EXPECT_TRUE(hub_->Expect("From @FSM tell pictures to NONE")) << "nobody looks any more";
}

TEST_F(WebTest, ViewersWhoHaveClosedTakeNoPlaceWhileAFaceDrawsNothing) {
  hub_->WriteLine("to @FSM set#off Frames = OFF");
  ASSERT_TRUE(hub_->Expect("rep#off Frames = OFF"));
  constexpr int kMoreThanThereArePlaces = 80;
  for (int i = 0; i < kMoreThanThereArePlaces; ++i) {
    Open("/face.mjpg", Host() + Cookie());
    EXPECT_EQ(StatusOf("/", Host() + Cookie()), "200") << i;
  }
}

TEST_F(WebTest, WhatIsNoPictureEndsThePicturesAndSaysSo) {
  hub_->WriteLine("to @FSM set#off Frames = OFF");
  ASSERT_TRUE(hub_->Expect("rep#off Frames = OFF"));
  for (const char* record :
       {R"(picture 1 8388609\n)", R"(picture x 4\n)", R"(picture 1 2 3\n)", R"(film 1 4\n)"}) {
    const auto face = Open("/face", Host() + Cookie() + Socket("http://" + host_));
    ASSERT_TRUE(hub_->Expect("From @FSM tell pictures to unix:")) << hub_->Seen();
    hub_->WriteLine("to @FSM set Say = " + std::string(record));
    ASSERT_TRUE(hub_->Expect("From @FSM tell pictures to NONE")) << record;
    face->CloseInput();
    face->ReadAll();
    EXPECT_NE(face->Seen().find("expected picture MS BYTES"), std::string::npos) << record;
  }
  hub_->WriteLine("inq#alive Run");
  EXPECT_TRUE(hub_->Expect("rep#alive Run = LIVE")) << hub_->ErrorText();
}

TEST_F(WebTest, AFilmAndThePageDoNotDisturbEachOther) {
  hub_->WriteLine("to @FSM set Record = /dev/null");
  hub_->WriteLine("to @FSM inq#1 Record");
  ASSERT_TRUE(hub_->Expect("rep#1 Record = /dev/null"));
  const auto video = Open("/face.mjpg", Host() + Cookie());
  EXPECT_TRUE(video->Expect("Content-Type: image/jpeg")) << hub_->ErrorText();
  hub_->WriteLine("to @FSM inq#2 Record");
  EXPECT_TRUE(hub_->Expect("rep#2 Record = /dev/null"));
}

TEST_F(WebTest, PicturesThatSomebodyElseTakesAreNotTakenAway) {
  hub_->WriteLine("to @FSM set#1 Picture.to = elsewhere");
  ASSERT_TRUE(hub_->Expect("rep#1 Picture.to = elsewhere"));
  EXPECT_EQ(StatusOf("/face.mjpg", Host() + Cookie()), "503");
  hub_->WriteLine("to @FSM inq#2 Picture.to");
  EXPECT_TRUE(hub_->Expect("rep#2 Picture.to = elsewhere"));
}

TEST_F(WebTest, TheVoicesSoundComesWithItsTimeWhileSomebodyListens) {
  const std::string headers = Host() + Cookie() + Socket("http://" + host_);
  {
    const auto voice = Open("/voice", headers);
    ASSERT_TRUE(voice->Expect("101 Switching")) << hub_->ErrorText();
    ASSERT_TRUE(hub_->Expect("From @SSM tell sound to unix:")) << hub_->Seen();
    // In two pieces, the second of which begins within the samples.
    hub_->WriteLine(R"(to @SSM set#1 Say = sound 12.5 16000 4\nA)");
    hub_->WriteLine(R"(to @SSM set#2 Say = B\nCend 20\nsound 1 2 3\n)");
    // A line feed stands among the samples, as one may.
    EXPECT_TRUE(voice->Expect("AB")) << hub_->ErrorText();
    ASSERT_TRUE(hub_->Expect("From @SSM tell sound to NONE")) << hub_->Seen();
    // By the next answer the hub has written why, and the end of input cannot come before it.
    hub_->WriteLine("inq#3 Refused");
    ASSERT_TRUE(hub_->Expect("rep#3 Refused")) << hub_->Seen();
    voice->CloseInput();
    voice->ReadAll();
    EXPECT_NE(voice->Seen().find("the voice sent 'sound 1 2 3'"), std::string::npos)
        << "what is no record ends the sound and says so";
  }
  {
    const auto voice = Open("/voice", headers);
    ASSERT_TRUE(hub_->Expect("From @SSM tell sound to unix:")) << "as often as somebody comes";
  }
  EXPECT_TRUE(hub_->Expect("From @SSM tell sound to NONE")) << "nobody listens any more";
  EXPECT_EQ(StatusOf("/voice", Host() + Socket("")), "401");
  EXPECT_EQ(StatusOf("/voice", Host() + Cookie() + Socket("http://evil.example")), "403");
}

TEST_F(WebTest, TheFaceComesAsPicturesWithTimes) {
  const std::string headers = Host() + Cookie() + Socket("http://" + host_);
  {
    const auto face = Open("/face", headers);
    ASSERT_TRUE(face->Expect("101 Switching")) << hub_->ErrorText();
    EXPECT_TRUE(face->Expect("JFIF")) << hub_->ErrorText();
  }
  EXPECT_TRUE(hub_->Expect("From @FSM tell pictures to NONE")) << "nobody looks any more";
  EXPECT_EQ(StatusOf("/face", Host() + Socket("")), "401");
  EXPECT_EQ(StatusOf("/face", Host() + Cookie() + Socket("http://evil.example")), "403");
}

TEST_F(WebTest, MetricsAreInTheFormOfPrometheus) {
  hub_->WriteLine("set#1 Start = FSM");
  ASSERT_TRUE(hub_->Expect("rep#1 Start = READY"));
  const auto metrics = Open("/metrics", Host() + "Authorization: Bearer " + kToken + "\r\n");
  EXPECT_TRUE(metrics->Expect("200 OK"));
  EXPECT_TRUE(metrics->Expect("# TYPE galatea_messages_in_total counter"));
  EXPECT_TRUE(metrics->Expect("galatea_messages_in_total{peer=\"FSM\"} "));
  EXPECT_TRUE(metrics->Expect("galatea_module_ready{module=\"FSM\"} 1"));
}

TEST_F(WebTest, AMicrophoneBecomesTheEarsInputAndThenNoMore) {
  hub_->WriteLine("to @SRM set#1 Listen = START");
  ASSERT_TRUE(hub_->Expect("rep#1 Listen = START"));
  {
    const auto microphone = Open("/microphone", Host() + Cookie() + Socket("http://" + host_));
    ASSERT_TRUE(microphone->Expect("101 Switching")) << hub_->ErrorText();
    EXPECT_EQ(StatusOf("/microphone", Host() + Cookie() + Socket("http://" + host_)), "409")
        << "one at a time";
    std::string samples;  // half a second of 1000 Hz at 16 kHz
    for (int i = 0; i < 8000; ++i)
      samples += i % 16 < 8 ? std::string("\0\x20", 2) : std::string("\0\xe0", 2);
    std::string frame = Frame(samples);
    frame[0] = '\x82';  // binary
    microphone->Write(frame);
    // 499 times through zero in half a second.
    EXPECT_TRUE(hub_->Expect("From @SRM rep Result = 998")) << hub_->Seen() << hub_->ErrorText();
  }
  std::string input;
  for (int i = 0; i < 100 && input.find("= NONE") == std::string::npos; ++i) {
    hub_->WriteLine("to @SRM inq#2 Input");
    input = hub_->Expect("rep#2 Input").value_or("");
  }
  EXPECT_NE(input.find("= NONE"), std::string::npos) << "as it was before";
  EXPECT_EQ(StatusOf("/microphone", Host() + Socket("")), "401");
  EXPECT_EQ(StatusOf("/microphone", Host() + Cookie() + Socket("http://evil.example")), "403");
}

TEST_F(WebTest, AMicrophoneThatGoesWhileTheEarIsSilentLeavesItsPlaceToTheNext) {
  const std::string headers = Host() + Cookie() + Socket("http://" + host_);
  hub_->WriteLine("to @SRM set#1 Deaf = YES");
  ASSERT_TRUE(hub_->Expect("rep#1 Deaf = YES"));
  {
    const auto microphone = Open("/microphone", headers);
    ASSERT_TRUE(microphone->Expect("101 Switching")) << hub_->ErrorText();
    EXPECT_EQ(StatusOf("/microphone", headers), "409");
  }
  std::string status = "409";
  for (int i = 0; i < 100 && status == "409"; ++i) status = StatusOf("/microphone", headers);
  EXPECT_EQ(status, "101");
}

const char* Chromium() {
  for (const char* name : {"chromium", "chromium-headless-shell"}) {
    if (std::system(("command -v " + std::string(name) + " >/dev/null").c_str()) == 0) return name;
  }
  return nullptr;
}

TEST_F(WebTest, WhatABrowsersMicrophoneHearsTheEarUnderstands) {
  const char* const browser = Chromium();
  if (browser == nullptr)
    GTEST_SKIP() << "no chromium here (Debian package chromium-headless-shell or chromium)";
  const std::string sound = folder_ / "tone.wav";
  ASSERT_EQ(std::system(("python3 -c \"import wave, math, struct; w = wave.open('" + sound +
                         "', 'wb'); w.setparams((1, 2, 48000, 0, 'NONE', '')); "
                         "w.writeframes(b''.join(struct.pack('<h', int(12000 * math.sin(i * "
                         "math.tau * 500 / 48000))) for i in range(96000)))\"")
                            .c_str()),
            0);
  Process page(
      {"python3", GALATEA_SOURCE_DIR "/tests/support/browse.py", browser, folder_ / "profile",
       "http://" + host_ + "/module.html?token=" + kToken, "--use-fake-ui-for-media-stream",
       "--use-fake-device-for-media-stream", "--use-file-for-fake-audio-capture=" + sound,
       "--autoplay-policy=no-user-gesture-required", "wait:document.querySelector('#link.on')",
       "wait:document.querySelector('#flow').textContent.includes('inq Clock')",
       "do:document.querySelector('#listen').click()",
       "wait:/^(49|50)\\d$/.test(document.querySelector('#said').textContent)",
       "picture:" + (folder_ / "microphone.png"), "do:document.querySelector('#listen').click()",
       "wait:document.querySelector('#said').textContent == 'Not listening.'"});
  EXPECT_EQ(page.Wait(support::Millis(120000)), 0) << page.ErrorText() << hub_->ErrorText();
  EXPECT_TRUE(hub_->Expect("From @PAGE rep Listen = ON")) << hub_->Seen();
  EXPECT_TRUE(hub_->Expect("From @PAGE rep Result = ")) << "what it hears is its Result";
}

/// A port nobody listens at now.
unsigned short FreePort() {
  const int probe = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ::bind(probe, reinterpret_cast<const sockaddr*>(&address), size);
  ::getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(probe);
  return ntohs(address.sin_port);
}

/// A hub whose page has no token of the configuration's.
struct PlainHub {
  PlainHub(const std::string& state, unsigned short port)
      : hub({kHub, "--web", std::to_string(port)},
            {.cwd = "", .env = {"XDG_STATE_HOME=" + state}}) {
    EXPECT_TRUE(hub.ExpectError("/?token=")) << hub.ErrorText();
    const std::string text = hub.ErrorText();
    address = text.substr(text.find("http://"));
    address = address.substr(0, address.find_first_of("\n "));
  }
  Process hub;
  std::string address;
};

TEST(WebTokenTest, OneThatNobodyHasSetStaysTheSameForAPortAndIsReadableByTheUserAlone) {
  const support::TempDir state;
  const unsigned short port = FreePort();
  const auto address = [&](const std::string& at) { return PlainHub(at, port).address; };
  const std::string file = state / ("galatea/page_token_" + std::to_string(port));
  const auto first = address(state / "");
  EXPECT_EQ(address(state / ""), first);
  struct stat info {};
  ASSERT_EQ(stat(file.c_str(), &info), 0) << file;
  EXPECT_EQ(info.st_mode & 0777, 0600U);
  chmod(file.c_str(), 0644);
  const auto second = address(state / "");
  EXPECT_NE(second, first) << "others may have read it";
  ASSERT_EQ(stat(file.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600U);
  std::ofstream(file) << "short\n";
  EXPECT_EQ(address(state / "").size(), first.size());
  EXPECT_NE(address("/dev/null"), address("/dev/null"))
      << "where none can be kept there is one all the same";
}

class WebPageTest : public WebTest {
 protected:
  void SetUp() override {
    if (Chromium() == nullptr)
      GTEST_SKIP() << "no chromium here (Debian package chromium-headless-shell or chromium)";
  }
  /// A browser that shows the page and takes these steps (tests/support/browse.py).
  std::unique_ptr<Process> Browse(std::vector<std::string> steps) {
    std::vector<std::string> command{"python3",
                                     GALATEA_SOURCE_DIR "/tests/support/browse.py",
                                     Chromium(),
                                     folder_ / "profile",
                                     Address() + "?token=" + kToken,
                                     "--autoplay-policy=no-user-gesture-required",
                                     "--lang=en",
                                     "wait:document.querySelector('#link.on')"};
    command.insert(command.end(), steps.begin(), steps.end());
    return std::make_unique<Process>(command);
  }
  std::string Address() const { return "http://" + host_ + "/"; }
  static std::string Type(const std::string& words) {
    return "do:document.querySelector('#text').value = '" + words +
           "'; document.querySelector('#speak button').click()";
  }
  static std::string Choose(const std::string& picker, const std::string& value) {
    return "do:document.querySelector('#pick-" + picker + "').value = '" + value +
           "'; document.querySelector('#pick-" + picker + "').onchange()";
  }
  static std::string Tell(const std::string& text) {
    return "do:galatea.hub.send('to @CONSOLE tell " + text + "')";
  }
};

/// The engineer's view.
TEST_F(WebPageTest, AnEngineerSeesModulesSlotsAndMessages) {
  const auto page = Browse(
      {"do:document.querySelector('#engineer-tab').click()",
       "wait:document.querySelector('#modules td.READY')",
       "wait:[...document.querySelectorAll('#whose option')].some(o => o.value == 'FSM')",
       "do:document.querySelector('#line').value = 'to @CONSOLE set Seen = 5'; "
       "document.querySelector('#line-form button').click()",
       "wait:document.querySelector('#flow').textContent.includes('set#u')",
       "do:document.querySelector('[aria-label=\"Restart FSM\"]').click()",
       "wait:document.querySelector('#answer').textContent == 'READY'",
       "wait:document.querySelector('#modules .why').textContent.includes('ended with')",
       "do:document.querySelector('#whose').value = 'AM'; "
       "document.querySelector('#whose').onchange()",
       "wait:[...document.querySelectorAll('#slots summary')].some(s => "
       "s.textContent.startsWith('the hub'))",
       "do:document.querySelector('#slot-filter').value = 'protocolv'; "
       "document.querySelector('#slot-filter').oninput()",
       "wait:document.querySelector('#slots details[open] [aria-label=ProtocolVersion]')"
       ".value.includes('1.0')",
       "print:[...document.querySelectorAll('#slots tr')].filter(r => r.checkVisibility()).length",
       "print:location.href", "picture:" + (folder_ / "page.png"),
       "do:location.href = 'module.html'",
       "wait:document.querySelector('#flow').textContent.includes('inq Clock')",
       "print:document.title"});
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "1") << "of all slots the filter shows one";
  EXPECT_EQ(page->ReadLine(), Address()) << "the token has left the address";
  EXPECT_EQ(page->ReadLine(), "A page as a module of Galatea");
  EXPECT_TRUE(hub_->Expect("Seen = 5")) << "what was typed arrived";
  EXPECT_TRUE(hub_->Expect("From @PAGE rep Run = LIVE")) << "the other page is a module";
}

TEST_F(WebPageTest, ATypedLineGoesToWhoAnswersAndTheLogHasWhatBothSay) {
  const auto page =
      Browse({"wait:document.querySelector('#way').dataset.text == 'way_voice'", Tell("alone"),
              "wait:document.querySelector('#way').dataset.text == 'way_chat'", Type("Hello there"),
              "wait:document.querySelector('#status').textContent == 'thinking …'",
              "wait:document.querySelector('#subtitle').textContent == 'Good day.'",
              "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')",
              "do:document.querySelector('#hush').click()",
              "wait:document.querySelector('#log').innerText.includes('interrupted')",
              "wait:document.querySelector('#subtitle').textContent == ''"});
  ASSERT_TRUE(hub_->Expect("tell alone")) << page->ErrorText();
  const auto chat = SocketClient::Unix(folder_ / "hub");
  chat->WriteLine("to @AM set Name = CHAT");
  chat->WriteLine("rep Run = LIVE");
  ASSERT_TRUE(chat->Expect("inq Listen")) << page->ErrorText();
  chat->WriteLine("rep Listen = ON");
  EXPECT_TRUE(chat->Expect("Input.text = Hello there")) << page->ErrorText() << chat->Seen();
  chat->WriteLine("rep Heard = Hello there");
  chat->WriteLine("rep Busy = THINKING");
  for (const char* line :
       {"rep Speak.text = Good day.", "rep Speak.dur = 900", "rep Speak.stat = SPEAKING"})
    chat->WriteLine("to @SSM set Tell = " + std::string(line));
  ASSERT_TRUE(chat->Expect("Say = STOP")) << page->ErrorText();
  for (const char* line : {"rep Speak.len = 400", "rep Speak.stat = IDLE"})
    chat->WriteLine("to @SSM set Tell = " + std::string(line));
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "You Hello there Galatea Good day.");
}

TEST_F(WebPageTest, AnAnswerIsReadWhereTheVoiceIsAwayAndNobodyToAnswerIsNamed) {
  const auto page = Browse(
      {Tell("here"), "wait:document.querySelector('#way').dataset.text == 'way_chat'",
       "do:galatea.hub.send('to @AM set Stop = SSM')",
       "wait:document.querySelector('#way').dataset.text == 'way_chat_silent'", Type("Hello"),
       "wait:document.querySelector('#log').innerText.includes('Be well.')", Tell("read"),
       "wait:document.querySelector('#way').dataset.text == 'way_no_chat'", Type("Still there?"),
       "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')",
       "print:document.querySelector('#text').value"});
  ASSERT_TRUE(hub_->Expect("tell here")) << page->ErrorText();
  auto chat = SocketClient::Unix(folder_ / "hub");
  chat->WriteLine("to @AM set Name = CHAT");
  chat->WriteLine("rep Run = LIVE");
  ASSERT_TRUE(chat->Expect("inq Listen")) << page->ErrorText();
  chat->WriteLine("rep Listen = ON");
  ASSERT_TRUE(chat->Expect("Input.text = Hello")) << page->ErrorText() << chat->Seen();
  for (const char* line : {"rep Busy = THINKING", "rep Reply.sentence = Good day.",
                           "rep Say.error = UNAVAILABLE the voice @SSM is not there",
                           "rep Reply.sentence = Be well.", "rep Busy = IDLE"})
    chat->WriteLine(line);
  ASSERT_TRUE(hub_->Expect("tell read")) << page->ErrorText();
  chat.reset();
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(
      page->ReadLine(),
      "You Hello Galatea Good day. The voice (module SSM) is not there: answers can only be "
      "read. Galatea Be well. You Still there? Nobody answers: the module CHAT is not there.");
}

TEST_F(WebPageTest, AVoiceThatDiesInTheMiddleLeavesTheWholeAnswerToRead) {
  const auto page =
      Browse({Tell("here"), "wait:document.querySelector('#way').dataset.text == 'way_chat'",
              Type("Hello"), "wait:document.querySelector('#subtitle').textContent == 'Good day.'",
              "do:galatea.hub.send('to @AM set Stop = SSM')",
              "wait:document.querySelector('#way').dataset.text == 'way_chat_silent'", Tell("gone"),
              "wait:document.querySelector('#log').innerText.includes('Be well.')",
              "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')"});
  ASSERT_TRUE(hub_->Expect("tell here")) << page->ErrorText();
  const auto chat = SocketClient::Unix(folder_ / "hub");
  chat->WriteLine("to @AM set Name = CHAT");
  chat->WriteLine("rep Run = LIVE");
  ASSERT_TRUE(chat->Expect("inq Listen")) << page->ErrorText();
  chat->WriteLine("rep Listen = ON");
  ASSERT_TRUE(chat->Expect("Input.text = Hello")) << page->ErrorText() << chat->Seen();
  for (const char* line : {"rep Busy = THINKING", "rep Reply.sentence = Good day.",
                           "to @SSM set Tell = rep Speak.text = Good day.",
                           "to @SSM set Tell = rep Speak.stat = SPEAKING"})
    chat->WriteLine(line);
  ASSERT_TRUE(hub_->Expect("tell gone")) << page->ErrorText();
  for (const char* line : {"rep Say.error = UNAVAILABLE @SSM has gone in the middle of it",
                           "rep Reply.sentence = Be well.", "rep Busy = IDLE"})
    chat->WriteLine(line);
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(),
            "You Hello Galatea Good day. The voice (module SSM) is not there: answers can only be "
            "read. Galatea Be well.");
}

TEST_F(WebPageTest, WhatIsTypedAsSoonAsThePageIsConnectedWaitsUntilItKnowsWhoIsThere) {
  const auto chat = SocketClient::Unix(folder_ / "hub");
  chat->WriteLine("to @AM set Name = CHAT");
  chat->WriteLine("rep Run = LIVE");
  const auto page =
      Browse({"wait:document.querySelector('#way').dataset.text == 'way_chat'",
              "do:new MutationObserver(() => { if "
              "(document.querySelector('#link.on') && !window.said) { window.said = "
              "document.querySelector('#way').dataset.text; " +
                  Type("Early").substr(3) +
                  "} }).observe(document.querySelector('#link'), {attributes: true}); "
                  "galatea.hub.socket.close()",
              "wait:window.said", "wait:document.querySelector('#log').innerText.includes('Early')",
              "print:window.said",
              "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')"});
  for (int visit = 0; visit < 2; ++visit) {
    ASSERT_TRUE(chat->Expect("inq Listen")) << page->ErrorText();
    chat->WriteLine("rep Listen = ON");
  }
  EXPECT_TRUE(chat->Expect("Input.text = Early")) << page->ErrorText() << chat->Seen();
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_NE(page->ReadLine(), "way_chat") << "it was typed before the module was known";
  EXPECT_EQ(page->ReadLine(), "You Early");
}

TEST_F(WebPageTest, ADialogueBeginsWithThePageAndCanBeStartedAgain) {
  Process dialog({GALATEA_SOURCE_DIR "/scripts/web_dialog.py", "--connect",
                  "unix:" + (folder_ / "hub"), "--name", "DIALOG", "--", "sh", "-c",
                  "echo begun; sleep 1"});
  const auto page =
      Browse({"wait:!document.querySelector('#again').hidden",
              "do:document.querySelector('#again').click()",
              "wait:document.querySelector('#again').hidden",
              "wait:!document.querySelector('#again').hidden", Type("Hello"),
              "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')"});
  EXPECT_TRUE(dialog.Expect("begun")) << dialog.ErrorText();
  EXPECT_TRUE(dialog.Expect("run_agent: the dialogue is over")) << dialog.ErrorText();
  EXPECT_TRUE(dialog.Expect("begun")) << "again";
  EXPECT_EQ(page->Wait(support::Millis(60000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(),
            "The dialogue is over. The dialogue is over. You Hello The dialogue is over: nobody "
            "listens.");
}

TEST_F(WebPageTest, OnANarrowPageThePickersFoldAndLogAndButtonsStayInView) {
  const std::string settle = "do:new Promise(done => setTimeout(done, 300))";
  const std::string seen =
      "print:['#log', '#text', '#microphone'].every(each => "
      "document.querySelector(each).getBoundingClientRect().bottom <= innerHeight) + ' ' + "
      "document.querySelector('#settings').open";
  const auto page =
      Browse({"size:1280x850", settle, seen, "size:400x850", settle, seen, "size:820x850", settle,
              seen, "do:document.querySelector('#settings summary').click()", settle,
              "print:document.querySelector('#pick-face').checkVisibility()", "size:1280x850",
              settle, seen});
  EXPECT_EQ(page->Wait(support::Millis(60000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "true true");
  EXPECT_EQ(page->ReadLine(), "true false");
  EXPECT_EQ(page->ReadLine(), "true false");
  EXPECT_EQ(page->ReadLine(), "True") << "they can be unfolded";
  EXPECT_EQ(page->ReadLine(), "true true");
}

TEST_F(WebPageTest, WhatHasGoneSaysSoAndWhatComesBackIsAsItWasChosen) {
  const auto page = Browse(
      {"wait:document.querySelector('#face').width === 16 && "
       "!document.querySelector('#stage.off')",
       "wait:document.querySelector('#pick-face').value == 'galatea'",
       "wait:document.querySelector('#pick-voice').value == 'anna'", Choose("face", "pygmalion"),
       Choose("voice", "ben"), Tell("chosen"), "wait:document.querySelector('#stage.off')",
       "wait:document.querySelector('#face-off').textContent.startsWith('No face: ')",
       Tell("seen to go"), "wait:!document.querySelector('#stage.off')",
       "wait:!document.querySelector('#pick-face').disabled",
       "wait:document.querySelector('#pick-voice').disabled", Tell("seen the voice go"),
       "wait:!document.querySelector('#pick-voice').disabled",
       "print:document.querySelector('#pick-face').value"});
  ASSERT_TRUE(hub_->ExpectAll({"tell wears pygmalion", "tell speaks as ben", "tell chosen"}))
      << page->ErrorText();
  hub_->WriteLine("set Stop = FSM");
  ASSERT_TRUE(hub_->Expect("tell seen to go")) << page->ErrorText();
  hub_->WriteLine("set Start = FSM");
  EXPECT_TRUE(hub_->Expect("tell wears pygmalion")) << "again";
  hub_->WriteLine("set Stop = SSM");
  ASSERT_TRUE(hub_->Expect("tell seen the voice go")) << page->ErrorText();
  hub_->WriteLine("set Start = SSM");
  EXPECT_TRUE(hub_->Expect("tell speaks as ben")) << "again";
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "pygmalion");
}

TEST_F(WebPageTest, AnOpenPageGoesOnWhenTheHubHasBeenStartedAnew) {
  const support::TempDir state;
  const unsigned short port = FreePort();
  auto first = std::make_unique<PlainHub>(state / "", port);
  Process page(
      {"python3", GALATEA_SOURCE_DIR "/tests/support/browse.py", Chromium(), folder_ / "profile",
       first->address, "--lang=en", "wait:document.querySelector('#link.on')",
       "do:galatea.hub.send('to @CONSOLE tell there')", "wait:document.querySelector('#link.off')",
       "wait:document.querySelector('#link.on')", "wait:galatea.clock.known",
       "do:galatea.hub.send('to @CONSOLE tell there again')",
       "print:document.querySelector('#link').textContent"});
  ASSERT_TRUE(first->hub.Expect("tell there")) << page.ErrorText();
  first.reset();
  PlainHub second(state / "", port);
  EXPECT_TRUE(second.hub.Expect("tell there again")) << page.ErrorText();
  EXPECT_EQ(page.Wait(support::Millis(60000)), 0) << page.ErrorText();
  EXPECT_EQ(page.ReadLine(), "connected");
}

}  // namespace
