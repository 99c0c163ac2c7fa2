#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "task_manager/fetch/fetcher.h"
#include "task_manager/fetch/uri.h"
#include "tests/support/process.h"
#include "tests/task_manager/case_file.h"
#include "tests/task_manager/http_server.h"

namespace vxml_test {
namespace {

using vxml::fetch::Fetcher;
using vxml::fetch::Options;
using vxml::fetch::Request;
using vxml::fetch::Resolve;

/// A fetcher whose clock the test moves.
class FetcherTest : public ::testing::Test {
 protected:
  Options WithClock() {
    Options options;
    options.now = [this] { return now_; };
    return options;
  }
  Request For(const std::string& uri) {
    Request request;
    request.uri = uri;
    return request;
  }
  long long now_ = 1'000'000'000;
};

TEST(UriTest, ReferencesAreResolvedAsTheRfcSays) {
  const std::string base = "http://a/b/c/d;p?q";
  EXPECT_EQ(Resolve(base, "g"), "http://a/b/c/g");
  EXPECT_EQ(Resolve(base, "./g/"), "http://a/b/c/g/");
  EXPECT_EQ(Resolve(base, "/g"), "http://a/g");
  EXPECT_EQ(Resolve(base, "//g"), "http://g/");
  EXPECT_EQ(Resolve(base, "?y"), "http://a/b/c/d;p?y");
  EXPECT_EQ(Resolve(base, "#s"), "http://a/b/c/d;p?q#s");
  EXPECT_EQ(Resolve(base, "../../../g"), "http://a/g");
  EXPECT_EQ(Resolve(base, ""), "http://a/b/c/d;p?q");
  EXPECT_EQ(Resolve(base, "g;x=1/../y"), "http://a/b/c/y");
  EXPECT_EQ(Resolve(base, "file:/x"), "file:///x");
  EXPECT_EQ(Resolve(base, "data:,a/../b#c"), "data:,a/../b#c");
  EXPECT_EQ(Resolve(base, "builtin:grammar/date"), "builtin:grammar/date");
  EXPECT_EQ(Resolve("data:,x", "g"), "g");
  EXPECT_EQ(Resolve("", "g"), "g");
  EXPECT_EQ(Resolve("file:///a%20b/c", "d \u3042.vxml#\u3042"),
            "file:///a%20b/d%20%e3%81%82.vxml#\u3042");
}

TEST(UriTest, PathsBecomeUrisAndComeBack) {
  for (const std::string path : {"/a b/\u3042%20?#x.vxml", "/plain/x.vxml", "/"}) {
    EXPECT_EQ(vxml::fetch::PathOf(vxml::fetch::FromPath(path)), path);
  }
  EXPECT_EQ(vxml::fetch::FromPath("/a/../b c"), "file:///b%20c");
  EXPECT_EQ(vxml::fetch::FromPath("HTTP://a/b"), "HTTP://a/b");
  EXPECT_FALSE(vxml::fetch::PathOf("http://a/b"));
  EXPECT_FALSE(vxml::fetch::PathOf("/a/b"));
  EXPECT_FALSE(vxml::fetch::PathOf("file:///a%00b"));
}

TEST_F(FetcherTest, FreshAnswersComeFromTheCache) {
  HttpServer server([](const auto&) { return Answer("x", "Cache-Control: max-age=60\r\n"); });
  Fetcher fetcher(WithClock());
  EXPECT_FALSE(fetcher.Fetch(For(server.Url("/a")))->from_cache);
  now_ += 59;
  EXPECT_TRUE(fetcher.Fetch(For(server.Url("/a")))->from_cache);
  now_ += 2;
  EXPECT_FALSE(fetcher.Fetch(For(server.Url("/a")))->from_cache);
  EXPECT_EQ(server.requests().size(), 2U);
}

TEST_F(FetcherTest, CookiesLastAsLongAsTheSession) {
  HttpServer server([](const HttpServer::Request& request) {
    if (request.target == "/login") {
      return Answer("", "Set-Cookie: id=7; Path=/in\r\nLocation: /in/a\r\n", "302 Found");
    }
    return Answer("x", "Cache-Control: no-store\r\n");
  });
  Fetcher fetcher(WithClock());
  EXPECT_TRUE(fetcher.Fetch(For(server.Url("/login"))));
  EXPECT_TRUE(fetcher.Fetch(For(server.Url("/in/b"))));
  EXPECT_TRUE(fetcher.Fetch(For(server.Url("/out"))));
  Fetcher other(WithClock());
  EXPECT_TRUE(other.Fetch(For(server.Url("/in/c"))));
  const auto requests = server.requests();
  ASSERT_EQ(requests.size(), 5U);
  const auto has_cookie = [&](std::size_t i) {
    return requests[i].headers.find("\r\ncookie: id=7") != std::string::npos;
  };
  EXPECT_TRUE(has_cookie(1));
  EXPECT_TRUE(has_cookie(2));
  EXPECT_FALSE(has_cookie(3));
  EXPECT_FALSE(has_cookie(4));
}

TEST_F(FetcherTest, AServerCannotFattenTheSessionWithCookies) {
  int made = 0;
  HttpServer server([&made](const HttpServer::Request& request) {
    if (request.target == "/last") return Answer("x");
    std::string lines;
    for (int i = 0; i < 40; ++i) lines += "Set-Cookie: c" + std::to_string(made++) + "=1\r\n";
    return Answer("x", lines + "Cache-Control: no-store\r\n");
  });
  Fetcher fetcher(WithClock());
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(fetcher.Fetch(For(server.Url("/more"))));
  EXPECT_TRUE(fetcher.Fetch(For(server.Url("/last"))));
  EXPECT_EQ(server.requests().back().headers.find("cookie:"), std::string::npos);
}

TEST_F(FetcherTest, MaxageRefusesWhatIsOlder) {
  HttpServer server([](const auto&) { return Answer("x", "Cache-Control: max-age=600\r\n"); });
  Fetcher fetcher(WithClock());
  ASSERT_TRUE(fetcher.Fetch(For(server.Url("/a"))));
  now_ += 10;
  Request request = For(server.Url("/a"));
  request.max_age = 5;
  EXPECT_FALSE(fetcher.Fetch(request)->from_cache);
}

TEST_F(FetcherTest, MaxstaleTakesWhatIsStale) {
  HttpServer server([](const auto&) { return Answer("x", "Cache-Control: max-age=1\r\n"); });
  Fetcher fetcher(WithClock());
  ASSERT_TRUE(fetcher.Fetch(For(server.Url("/a"))));
  now_ += 10;
  Request request = For(server.Url("/a"));
  request.max_stale = 30;
  EXPECT_TRUE(fetcher.Fetch(request)->from_cache);
}

TEST_F(FetcherTest, AnEtagIsAskedAbout) {
  HttpServer server([](const HttpServer::Request& request) {
    if (request.headers.find("if-none-match: \"v1\"") != std::string::npos) {
      return Answer("", "", "304 Not Modified");
    }
    return Answer("x", "ETag: \"v1\"\r\nCache-Control: no-cache\r\n");
  });
  Fetcher fetcher(WithClock());
  ASSERT_TRUE(fetcher.Fetch(For(server.Url("/a"))));
  const auto again = fetcher.Fetch(For(server.Url("/a")));
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->from_cache);
  EXPECT_EQ(again->body, "x");
}

TEST_F(FetcherTest, NoStoreIsNotKept) {
  HttpServer server(
      [](const auto&) { return Answer("x", "Cache-Control: no-store, max-age=60\r\n"); });
  Fetcher fetcher(WithClock());
  ASSERT_TRUE(fetcher.Fetch(For(server.Url("/a"))));
  EXPECT_FALSE(fetcher.Fetch(For(server.Url("/a")))->from_cache);
}

TEST_F(FetcherTest, RedirectionsAreFollowedButNotInCircles) {
  HttpServer server([](const HttpServer::Request& request) {
    if (request.target == "/end") return Answer("x");
    return Answer("", "Location: " + std::string(request.target == "/a" ? "/end" : "/b") + "\r\n",
                  "302 Found");
  });
  Fetcher fetcher(WithClock());
  EXPECT_EQ(fetcher.Fetch(For(server.Url("/a")))->uri, server.Url("/end"));
  EXPECT_FALSE(fetcher.Fetch(For(server.Url("/b"))));
}

TEST_F(FetcherTest, ARedirectionToAFileIsRefused) {
  HttpServer server(
      [](const auto&) { return Answer("", "Location: file:///etc/passwd\r\n", "302 Found"); });
  Fetcher fetcher(WithClock());
  const auto got = fetcher.Fetch(For(server.Url("/a")));
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, vm::Errc::kAccess);
}

TEST_F(FetcherTest, StatusIsReported) {
  HttpServer server([](const auto&) { return Answer("", "", "404 Not Found"); });
  Fetcher fetcher(WithClock());
  EXPECT_EQ(fetcher.Fetch(For(server.Url("/a"))).error().http_status, 404);
}

TEST_F(FetcherTest, AServerThatNeverAnswersIsLeft) {
  HttpServer server([](const auto&) { return std::string(); });
  Fetcher fetcher(WithClock());
  Request request = For(server.Url("/a"));
  request.timeout = std::chrono::milliseconds(100);
  EXPECT_EQ(fetcher.Fetch(request).error().code, vm::Errc::kTimeout);
}

TEST_F(FetcherTest, AnEndlessBodyIsCut) {
  HttpServer server([](const auto&) {
    return "HTTP/1.1 200 OK\r\nContent-Length: 4294967296\r\n\r\n" + std::string(300'000, 'x');
  });
  Options options = WithClock();
  options.max_bytes = 100'000;
  Fetcher fetcher(options);
  EXPECT_EQ(fetcher.Fetch(For(server.Url("/a"))).error().code, vm::Errc::kTooLong);
}

TEST_F(FetcherTest, OnlyAllowedPlacesAreFetched) {
  Options options = WithClock();
  options.allowed_roots = {"file:///nowhere/dialogs/"};
  Fetcher fetcher(options);
  EXPECT_EQ(fetcher.Fetch(For("file:///etc/hostname")).error().code, vm::Errc::kAccess);
  EXPECT_EQ(fetcher.Fetch(For("file:///nowhere/dialogs/../../etc/hostname")).error().code,
            vm::Errc::kAccess);
  EXPECT_EQ(fetcher.Fetch(For("file:///nowhere/dialogs/%2e%2e/x")).error().code, vm::Errc::kAccess);
  EXPECT_NE(fetcher.Fetch(For("file:///nowhere/dialogs/a")).error().code, vm::Errc::kAccess);
}

/// Whether a fetcher that may fetch from `root` tries to fetch `uri` (nothing answers there).
bool Tries(const std::string& root, const std::string& uri) {
  Options options;
  options.allowed_roots = {root};
  options.default_timeout = std::chrono::milliseconds(50);
  Fetcher fetcher(options);
  const auto got = fetcher.Get(uri);
  return got || got.error().code != vm::Errc::kAccess;
}

TEST(AllowedPlaceTest, AFolderIsItselfAndWhatLiesBelowIt) {
  EXPECT_TRUE(Tries("file:///nowhere/d", "file:///nowhere/d/x"));
  EXPECT_TRUE(Tries("file:///nowhere/d/", "file:///nowhere/d"));
  EXPECT_TRUE(Tries("file:///nowhere/d/a.vxml", "file:///nowhere/d/a.vxml?x=1"));
  EXPECT_TRUE(Tries("file:///nowhere/d", "file:///nowhere/e/../d/%78"));
  EXPECT_FALSE(Tries("file:///nowhere/d", "file:///nowhere/d2"));
  EXPECT_FALSE(Tries("file:///nowhere/d", "file:///nowhere/d2/x"));
  EXPECT_FALSE(Tries("file:///nowhere/d", "file:///nowhere/d/../d2"));
  EXPECT_FALSE(Tries("file:///nowhere/d", "file:///nowhere/d/%2e%2e/d2"));
  EXPECT_FALSE(Tries("file:///nowhere/d", "file:///nowhere/d%2f..%2fd2"));
  EXPECT_FALSE(Tries("file:///nowhere/d", "file:///nowhere"));
}

TEST(AllowedPlaceTest, AServerIsItselfInEverySpelling) {
  EXPECT_TRUE(Tries("http://127.0.0.1:1", "http://127.0.0.1:1/x"));
  EXPECT_TRUE(Tries("http://127.0.0.1:1/d", "HTTP://127.0.0.1:1/d/x?q"));
  EXPECT_TRUE(Tries("http://LOCALHOST:1/", "http://localhost.:1/x"));
  EXPECT_TRUE(Tries("http://invalid.invalid:80/", "http://invalid.invalid/x"));
  EXPECT_FALSE(Tries("http://127.0.0.1", "http://127.0.0.1.invalid/"));
  EXPECT_FALSE(Tries("http://127.0.0.1", "http://127.0.0.1@invalid.invalid/"));
  EXPECT_FALSE(Tries("http://127.0.0.1", "http://127.0.0.1:1/"));
  EXPECT_FALSE(Tries("http://127.0.0.1:1", "https://127.0.0.1:1/"));
  EXPECT_FALSE(Tries("http://127.0.0.1:1/d", "http://127.0.0.1:1/d2"));
  EXPECT_FALSE(Tries("http://127.0.0.1:1/d", "http://127.0.0.1:1/d/%2e%2e/x"));
  EXPECT_FALSE(Tries("http://127.0.0.1:1/d", "file:///d/x"));
}

TEST(AllowedPlaceTest, ASymbolicLinkIsWhereItLeads) {
  namespace fs = std::filesystem;
  const support::TempDir folder;
  fs::create_directory(folder / "open");
  std::ofstream(folder / "secret") << "secret";
  std::ofstream(folder / "open/plain") << "plain";
  fs::create_symlink(folder / "secret", folder / "open/link");
  fs::create_symlink("/", folder / "open/top");
  fs::create_symlink(folder / "open", folder / "other");
  const std::string root = vxml::fetch::FromPath(folder / "other");
  EXPECT_TRUE(Tries(root, vxml::fetch::FromPath(folder / "open/plain")));
  EXPECT_FALSE(Tries(root, vxml::fetch::FromPath(folder / "open/link")));
  EXPECT_FALSE(Tries(root, vxml::fetch::FromPath(folder / "other/link")));
  EXPECT_FALSE(Tries(root, vxml::fetch::FromPath(folder / "open/top/etc/hostname")));
}

TEST(AllowedPlaceTest, WhatIsNoPlaceIsRefusedAtTheStart) {
  Options options;
  for (const char* root : {"http://", "data:,x", "nonsense", "file://far/x"}) {
    options.allowed_roots = {root};
    EXPECT_THROW(Fetcher{options}, std::runtime_error) << root;
  }
}

TEST_F(FetcherTest, DataUrisHoldTheirBytes) {
  Fetcher fetcher(WithClock());
  EXPECT_EQ(fetcher.Fetch(For("data:,a%20b"))->body, "a b");
  EXPECT_EQ(fetcher.Fetch(For("data:text/plain;base64,aGVsbG8="))->body, "hello");
  EXPECT_EQ(fetcher.Fetch(For("data:;base64,aGVs%0AbG8"))->body, "hello");
  EXPECT_EQ(fetcher.Fetch(For("data:;base64,AAAA"))->body, std::string(3, '\0'));
  EXPECT_EQ(fetcher.Fetch(For("data:;base64,"))->body, "");
  for (const char* bad : {"aGVsbG8*", "aGVsbG8==", "aG=sbG8=", "a", "====", "=", "aGVsb"}) {
    EXPECT_FALSE(fetcher.Fetch(For(std::string("data:;base64,") + bad))) << bad;
  }
}

Outcome RunMain(const std::string& body, const std::string& script,
                const std::vector<std::string>& expected) {
  Case made;
  made.name = "http";
  made.files["main.vxml"] = body;
  made.script = script;
  made.expected = expected;
  return RunCase(made);
}

constexpr const char* kDone =
    "<vxml version=\"2.1\"><form><block><exit expr=\"'pass'\"/></block></form></vxml>";

TEST(SubmitTest, GetPutsTheNamelistIntoTheQuery) {
  HttpServer server([](const auto&) { return Answer(kDone); });
  const auto outcome = RunMain(
      "<form><block><var name=\"a\" expr=\"'x y'\"/><var name=\"o\" "
      "expr=\"({p:1,q:{r:'\u3042'}})\"/>"
      "<submit next=\"" +
          server.Url("/s") + "\" namelist=\"a o\"/></block></form>",
      "", {});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
  ASSERT_EQ(server.requests().size(), 1U);
  EXPECT_EQ(server.requests()[0].target, "/s?a=x%20y&o.p=1&o.q.r=%E3%81%82");
}

TEST(SubmitTest, PostPutsItIntoTheBody) {
  HttpServer server([](const auto&) { return Answer(kDone); });
  const auto outcome =
      RunMain("<form><field name=\"f\" type=\"boolean\"/><block><submit method=\"post\" next=\"" +
                  server.Url("/s") + "\"/></block></form>",
              "say yes", {});
  EXPECT_TRUE(outcome.pass) << outcome.why;
  EXPECT_EQ(server.requests()[0].method, "POST");
  EXPECT_EQ(server.requests()[0].body, "f=true");
}

TEST(SubmitTest, MultipartIsSentInParts) {
  HttpServer server([](const auto&) { return Answer(kDone); });
  const auto outcome = RunMain(
      "<form><block><var name=\"a\" expr=\"7\"/><submit method=\"post\" "
      "enctype=\"multipart/form-data\" "
      "namelist=\"a\" next=\"" +
          server.Url("/s") + "\"/></block></form>",
      "", {});
  EXPECT_TRUE(outcome.pass) << outcome.why;
  EXPECT_NE(server.requests()[0].body.find("name=\"a\"\r\n\r\n7"), std::string::npos);
}

TEST(HttpEventTest, TheStatusIsInTheEvent) {
  HttpServer server([](const auto&) { return Answer("", "", "404 Not Found"); });
  const auto outcome = RunMain(
      "<form><catch event=\"error.badfetch.http.404\"><pass/></catch><block>"
      "<goto next=\"" +
          server.Url("/none") + "\"/></block></form>",
      "", {});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

TEST(HttpEventTest, FetchtimeoutIsBadfetch) {
  HttpServer server([](const auto&) { return std::string(); });
  const auto outcome = RunMain(
      "<form><catch event=\"error.badfetch\"><pass/></catch><block>"
      "<goto fetchtimeout=\"100ms\" next=\"" +
          server.Url("/") + "\"/></block></form>",
      "", {});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

/// A dialogue that begins in a file and goes on to what a server says. `%HERE%` in it stands for
/// the URI of a folder of secrets.
class OriginTest : public ::testing::Test {
 protected:
  OriginTest() {
    std::ofstream(folder_ / "secret.xml") << "<secret>7</secret>";
    std::ofstream(folder_ / "secret.js") << "var secret = 7;";
    std::ofstream(folder_ / "secret.wav") << "sound";
    std::ofstream(folder_ / "secret.vxml")
        << Vxml("<form><block><exit expr=\"'read'\"/></block></form>");
    std::ofstream(folder_ / "secret.grxml")
        << "<grammar version=\"1.0\" xmlns=\"http://www.w3.org/2001/06/grammar\" "
           "xml:lang=\"en\" root=\"r\"><rule id=\"r\" scope=\"public\">x</rule></grammar>";
  }
  static std::string Vxml(const std::string& body, const std::string& attributes = "") {
    return "<vxml version=\"2.1\"" + attributes + ">" + body + "</vxml>";
  }
  std::string WithPaths(std::string text) const {
    for (std::size_t at; (at = text.find("%HERE%")) != std::string::npos;) {
      text.replace(at, 6, vxml::fetch::FromPath(folder_.path()));
    }
    return text;
  }
  /// What a document of a file goes on to, over http; "/redirect" leads to a secret.
  Outcome Remote(const std::string& document, const std::vector<std::string>& expected) {
    HttpServer server([&](const HttpServer::Request& request) {
      if (request.target == "/redirect") {
        return Answer("", "Location: " + WithPaths("%HERE%/secret.vxml") + "\r\n", "302 Found");
      }
      if (request.target == "/g.grxml") {
        return Answer(
            WithPaths("<grammar version=\"1.0\" xml:lang=\"en\" root=\"r\" "
                      "xmlns=\"http://www.w3.org/2001/06/grammar\"><rule id=\"r\"><ruleref "
                      "uri=\"%HERE%/secret.grxml\"/></rule></grammar>"));
      }
      return Answer(WithPaths(document));
    });
    return RunMain("<form><block><goto next=\"" + server.Url("/") + "\"/></block></form>", "say x",
                   expected);
  }
  static std::string Form(const std::string& content) {
    return Vxml("<catch event=\"error.noauthorization\"><exit expr=\"'pass'\"/></catch><form>" +
                content + "</form>");
  }
  support::TempDir folder_;
};

TEST_F(OriginTest, ADocumentFromHttpReadsNoFile) {
  for (const char* content :
       {"<block><data name=\"s\" src=\"%HERE%/secret.xml\"/></block>",
        "<block><script src=\"%HERE%/secret.js\"/></block>",
        "<block><goto next=\"%HERE%/secret.vxml\"/></block>",
        "<block><goto next=\"%HERE%/secret.vxml#x\"/></block>",
        "<block><goto expr=\"'FILE'+'%HERE%/secret.vxml'.substr(4)\"/></block>",
        "<block><submit next=\"%HERE%/secret.vxml\"/></block>",
        "<block><goto next=\"/redirect\"/></block>",
        "<subdialog name=\"s\" src=\"%HERE%/secret.vxml\"/>",
        "<field name=\"f\"><grammar src=\"%HERE%/secret.grxml\"/></field>",
        "<field name=\"f\"><grammar src=\"/g.grxml\"/></field>"}) {
    const auto outcome = Remote(Form(content), {});
    EXPECT_TRUE(outcome.pass) << content << outcome.why << outcome.transcript;
  }
}

TEST_F(OriginTest, ASoundOfAFileIsNotPlayedForIt) {
  const auto outcome =
      Remote(Form("<block><audio src=\"%HERE%/secret.wav\">nothing</audio></block>"),
             {"prompts: nothing"});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

TEST_F(OriginTest, AnApplicationRootOfAFileIsRefused) {
  for (const char* root : {"%HERE%/secret.vxml", "/redirect"}) {
    const auto outcome = Remote(Vxml("<form><block><exit expr=\"'ran'\"/></block></form>",
                                     std::string(" application=\"") + root + "\""),
                                {"reason: error.noauthorization"});
    EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
  }
}

TEST_F(OriginTest, ADocumentFromHttpSendsNoLinesToModules) {
  for (const char* content :
       {"<block><native>to @AM set Run = EXIT</native></block>",
        "<block><native expr=\"'to @AM set Run = EXIT'\"/></block>",
        "<block><prompt>a<native>to @AM set Run = EXIT</native></prompt></block>",
        "<block><prompt><media type=\"face\"><native>to @AM set Run = EXIT</native></media>"
        "</prompt></block>"}) {
    const auto outcome = Remote(Form(content), {"exit: pass", "commands: "});
    EXPECT_TRUE(outcome.pass) << content << outcome.why << outcome.transcript;
  }
}

TEST_F(OriginTest, ADocumentInADataUriIsNoFile) {
  const auto outcome = RunMain(
      "<form><block><goto next=\"data:application/voicexml+xml,%3Cvxml version='2.1'%3E%3Ccatch "
      "event='error.noauthorization'%3E%3Cexit "
      "expr='&quot;pass&quot;'/%3E%3C/catch%3E%3Cform%3E%3Cblock%3E"
      "%3Cnative%3Eto @AM set Run = "
      "EXIT%3C/native%3E%3C/block%3E%3C/form%3E%3C/vxml%3E\"/></block></form>",
      "", {"exit: pass", "commands: "});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

TEST_F(OriginTest, AFaceStillMovesForADocumentFromHttp) {
  const auto outcome = Remote(Form("<block><prompt><head lexeme=\"NOD\"/>yes</prompt></block>"),
                              {"commands: to @FSM set FaceMot = NOD 1"});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

TEST_F(OriginTest, AFileWhoseRootIsRemoteKeepsItsOwnRights) {
  HttpServer server([&](const HttpServer::Request&) {
    return Answer(WithPaths(
        Vxml("<catch event=\"ask\"><native>to @AM set Run = EXIT</native></catch>"
             "<catch event=\"error.noauthorization\"><exit expr=\"'refused'\"/></catch>")));
  });
  std::ofstream(folder_ / "leaf.vxml") << Vxml(
      "<form><block><native>to @FSM set A = 1</native><throw event=\"ask\"/></block></form>",
      " application=\"" + server.Url("/root") + "\"");
  const auto outcome =
      RunMain(WithPaths("<form><block><goto next=\"%HERE%/leaf.vxml\"/></block></form>"), "",
              {"exit: refused", "commands: to @FSM set A = 1"});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

TEST(HttpEventTest, DocumentsInShiftJisAreReadByTheirHeader) {
  HttpServer server([](const auto&) {
    return Answer(
        "<?xml version=\"1.0\"?><vxml version=\"2.0\"><form><block>\x82\xa0</block></form></vxml>",
        "Content-Type: application/voicexml+xml; charset=Shift_JIS\r\n");
  });
  const auto outcome =
      RunMain("<form><block><goto next=\"" + server.Url("/") + "\"/></block></form>", "",
              {"prompts: \u3042"});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

}  // namespace
}  // namespace vxml_test
