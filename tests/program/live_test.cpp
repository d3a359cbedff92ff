// A live view from outside: what it serves, to whom, and that the run does not notice.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <png.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "run_program.hpp"
#include "tests/support/cases.hpp"

namespace bedload::test {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

/// Fluid, grains, a wall that moves and a probe; without end it runs until it is stopped.
const std::string kCase = "title = \"stirred\"\n" + small_dam() + R"([[wall.body]]
name = "plate"
shape = "box"
type = "grains_only"
min = [0.07, 0.02, 0.04]
max = [0.08, 0.04, 0.06]
motion = { kind = "velocity", velocity = [0.001, 0, 0] }
[[probe]]
name = "front"
type = "front"
[time]
end = 1000
[out]
every = 0.01
)";

struct Answer {
  int status = 0;
  std::string head, body;
};

class Live : public ProgramTest {
 protected:
  void SetUp() override { write("stirred.toml", kCase); }
  void TearDown() override {
    if (pid_ > 0) end(SIGKILL);
  }

  /// Begins a run beside the test and waits until it tells its address.
  void begin(const std::string& options) {
    const std::string command =
        "cd '" + dir_.string() +
        "' && XDG_CACHE_HOME=cache OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive exec " BL_PROGRAM
        " run stirred.toml --backend cpu --live " +
        options + " >live.txt 2>live_err.txt";
    pid_ = fork();
    if (pid_ == 0) {
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    for (int n = 0; n < 3000 && port_ == 0; ++n) {
      const std::string out = content_of(dir_ / "live.txt"), before = "http://127.0.0.1:";
      if (const auto at = out.find(before); at != out.npos && out.find('\n', at) != out.npos)
        port_ = std::stoi(out.substr(at + before.size()));
      std::this_thread::sleep_for(20ms);
    }
    ASSERT_GT(port_, 0) << content_of(dir_ / "live_err.txt");
  }
  int end(int signal = 0) {
    if (signal) kill(pid_, signal);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  int connected(const char* address) const {
    const int s = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(std::uint16_t(port_));
    inet_pton(AF_INET, address, &to.sin_addr);
    if (connect(s, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0) return s;
    close(s);
    return -1;
  }
  Answer ask(const std::string& path, const std::string& host = "localhost:8020",
             const std::string& method = "GET") const {
    Answer out;
    const int s = connected("127.0.0.1");
    if (s < 0) return out;
    const std::string request =
        method + " " + path + " HTTP/1.1\r\n" + (host.empty() ? "" : "Host: " + host + "\r\n") + "\r\n";
    EXPECT_EQ(send(s, request.data(), request.size(), MSG_NOSIGNAL), ssize_t(request.size()));
    std::string all;
    char part[65536];
    for (ssize_t n; (n = recv(s, part, sizeof part, 0)) > 0;) all.append(part, std::size_t(n));
    close(s);
    const auto gap = all.find("\r\n\r\n");
    if (!all.starts_with("HTTP/1.1 ") || gap == all.npos) return out;
    return {std::stoi(all.substr(9)), all.substr(0, gap), all.substr(gap + 4)};
  }
  Json json(const std::string& path) const {
    const Answer a = ask(path);
    EXPECT_EQ(a.status, 200) << path << " " << a.body;
    return Json::parse(a.body, nullptr, false);
  }
  /// Asks for the status until it is as it should be.
  template <class F>
  Json status_when(F good) const {
    Json s;
    for (int n = 0; n < 3000; ++n) {
      s = json("/status");
      if (s.is_discarded() || good(s)) return s;
      std::this_thread::sleep_for(20ms);
    }
    ADD_FAILURE() << "did not come about: " << s;
    return s;
  }

  pid_t pid_ = 0;
  int port_ = 0;
};

/// Distinct colours of a PNG file, 0 if it is none.
std::size_t colours_of(const std::string& bytes, unsigned& width, unsigned& height) {
  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) return 0;
  png.format = PNG_FORMAT_RGBA;
  std::vector<std::uint32_t> pixels(PNG_IMAGE_SIZE(png) / 4);
  if (!png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr)) return 0;
  width = png.width, height = png.height;
  std::sort(pixels.begin(), pixels.end());
  return std::size_t(std::unique(pixels.begin(), pixels.end()) - pixels.begin());
}

TEST_F(Live, ShowsProgressTablesAndPictures) {
  begin("0 --out out");
  const Json s =
      status_when([](const Json& now) { return now["step"] > 20 && now["picture"]["serial"] > 0; });
  EXPECT_EQ(s["title"], "stirred");
  EXPECT_EQ(s["case"], "stirred");
  EXPECT_EQ(s["state"], "running");
  EXPECT_EQ(s["end"]["value"], 1000.0);
  EXPECT_GT(s["time"]["value"], 0);
  EXPECT_GT(s["dt"]["value"], 0);
  EXPECT_GT(s["steps_rate"]["value"], 0);
  EXPECT_GT(s["remaining"]["value"], 0);
  EXPECT_EQ(s["counts"]["grains"], 40);
  EXPECT_GT(s["picture"]["top_speed"]["value"], 0);
  status_when([](const Json& now) { return now["time"]["value"] > 0.05; });
  const Json later =
      status_when([&](const Json& now) { return now["picture"]["serial"] > s["picture"]["serial"]; });
  EXPECT_GT(later["picture"]["time"]["value"], s["picture"]["time"]["value"]) << "the picture refreshes";

  const Json tables = json("/tables");
  std::vector<std::string> names;
  for (const Json& table : tables) names.push_back(table["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"bodies/plate", "diagnostics", "probes/front"}));
  for (const std::string& name : names) {
    const Json table = json("/tables/" + name);
    const std::size_t rows = table["time"]["values"].size();
    EXPECT_GE(rows, 5u) << name;
    EXPECT_GE(table["rows"], rows);
    for (const Json& column : table["columns"]) {
      EXPECT_EQ(column["values"].size(), rows) << column["name"];
      EXPECT_FALSE(std::string(column["unit"]).empty()) << column["name"];
    }
  }
  // The same numbers as in the file that the run writes.
  const Json front = json("/tables/probes/front");
  EXPECT_EQ(front["time"]["values"][0], 0.0);
  std::stringstream csv(content_of(dir_ / "out/probes/front.csv"));
  std::string head, row;
  std::getline(csv, head), std::getline(csv, row), std::getline(csv, row);
  EXPECT_EQ(head.find("time [s]," + std::string(front["columns"][0]["name"]) + " ["), 0u) << head;
  EXPECT_EQ(std::stod(row), front["time"]["values"][1]);
  EXPECT_EQ(std::stod(row.substr(row.find(',') + 1)), front["columns"][0]["values"][1]);

  for (const std::string view : {"front", "above", "perspective"}) {
    const Answer a = ask("/picture.png?view=" + view);
    EXPECT_EQ(a.status, 200);
    EXPECT_NE(a.head.find("image/png"), a.head.npos);
    unsigned width = 0, height = 0;
    EXPECT_GT(colours_of(a.body, width, height), 100u) << view << " shows nothing";
    EXPECT_GE(width, 160u);
    EXPECT_GE(height, 160u);
  }
  const Answer page = ask("/");
  EXPECT_NE(page.body.find("<!doctype html>"), page.body.npos);
  for (const char* elsewhere : {"http://", "https://", "src=\"//"}) {
    std::string text = page.body;
    const std::string svg = "http://www.w3.org/2000/svg";  // a name, nothing that is fetched
    for (auto at = text.find(svg); at != text.npos; at = text.find(svg)) text.erase(at, svg.size());
    EXPECT_EQ(text.find(elsewhere), text.npos) << "the page asks for something elsewhere";
  }
  EXPECT_EQ(end(SIGINT), 130) << "as without a view";
  const std::string told = content_of(dir_ / "live.txt");
  EXPECT_NE(told.find("stopped at t = "), told.npos) << told;
}

TEST_F(Live, AnswersThisMachineAlone) {
  begin("0 --out out");
  for (const std::string host : {"localhost", "127.0.0.1", "localhost:1", "127.0.0.1:8020"})
    EXPECT_EQ(ask("/status", host).status, 200) << host;
  for (const std::string host :
       {"", "evil.example", "evil.example:8020", "localhost.evil.example", "127.0.0.1.evil.example",
        "localhost:", "localhost:80a", "localhost@evil.example", "127.0.0.11", "[::1]", "0.0.0.0"})
    for (const std::string path : {"/", "/status", "/tables", "/picture.png"})
      EXPECT_EQ(ask(path, host).status, 403) << host << path;
  for (const std::string method : {"POST", "PUT", "DELETE", "OPTIONS", "HEAD", "PATCH"})
    EXPECT_EQ(ask("/status", "localhost", method).status, 405) << method;
  for (const std::string path :
       {"/etc/passwd", "/../stirred.toml", "/stirred.toml", "/tables/../../stirred.toml", "/tables/nothing",
        "/tables/", "/%2e%2e/stirred.toml", "/out/diagnostics.csv", "/status/"})
    EXPECT_EQ(ask(path).status, 404) << path;
  EXPECT_EQ(ask("/picture.png?view=../stirred.toml").status, 400);
  EXPECT_NE(ask("/status").head.find("Cross-Origin-Resource-Policy: same-origin"), std::string::npos);
  EXPECT_EQ(connected("127.0.0.2"), -1) << "it listens at more than 127.0.0.1";
}

TEST_F(Live, LeavesResultsAsTheyAre) {
  const std::string run = " --overwrite --set time.end=0.12 --threads 1";
  const Outcome alone = bedload("run stirred.toml --backend cpu --quiet --out alone" + run);
  ASSERT_EQ(alone.code, 0) << alone.err;
  begin("0 --out seen" + run);
  Json last;
  std::int64_t pictures = 0;
  for (int n = 0; n < 6000; ++n) {
    const Answer a = ask("/status");
    if (a.status != 200) break;
    last = Json::parse(a.body);
    if (last["picture"]["serial"] > pictures && ask("/picture.png?view=perspective").status == 200)
      pictures = last["picture"]["serial"];
    if (last["state"] != "running" && last["state"] != "starting") break;
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(last["state"], "completed") << "whoever looks is told of the end";
  EXPECT_EQ(last["fraction"], 1.0);
  EXPECT_GT(pictures, 0);
  EXPECT_EQ(last["picture"]["time"], last["time"]) << "the last picture is of the end";
  EXPECT_EQ(json("/tables/probes/front")["time"]["values"].back(), last["time"]["value"]);
  EXPECT_EQ(end(), 0);
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(dir_ / "alone")) {
    const auto name = entry.path().lexically_relative(dir_ / "alone");
    if (!entry.is_regular_file() || name == "summary.json") continue;  // wall times
    EXPECT_TRUE(content_of(entry.path()) == content_of(dir_ / "seen" / name)) << name << " differs";
    ++files;
  }
  EXPECT_GE(files, 9) << "frames, tables, a checkpoint";
}

/// Connections that say nothing, or next to nothing, neither keep others waiting nor the run from its end.
TEST_F(Live, IsNotHeldUpByThoseWhoSayNothing) {
  begin("0 --out out");
  status_when([](const Json& now) { return now["step"] > 5; });
  std::vector<int> idle;
  for (int n = 0; n < 200; ++n) idle.push_back(connected("127.0.0.1"));
  const std::string slow = "GET /status HTTP/1.1\r\nHost: localhost\r\nX: ";
  for (int n = 0; n < 8; ++n) {
    idle.push_back(connected("127.0.0.1"));
    EXPECT_GT(send(idle.back(), slow.data(), slow.size(), MSG_NOSIGNAL), 0);
  }
  const auto now = [] { return std::chrono::steady_clock::now(); };
  auto from = now();
  for (int n = 0; n < 20; ++n) json("/status");
  char byte = 0;
  EXPECT_EQ(recv(idle[0], &byte, 1, 0), 0) << "the oldest of too many";
  EXPECT_LT(now() - from, 2s) << "as without them";
  from = now();
  for (int n = 0; n < 100; ++n) {  // each byte in time, the request not
    if (send(idle.back(), "a", 1, MSG_NOSIGNAL) < 0) break;
    std::this_thread::sleep_for(100ms);
  }
  EXPECT_LT(now() - from, 5s);
  idle.push_back(connected("127.0.0.1"));
  from = now();
  EXPECT_EQ(end(SIGTERM), 130);
  EXPECT_LT(now() - from, 10s);
  for (const int s : idle) close(s);
}

TEST_F(Live, RefusesWhatIsNoRequest) {
  begin("0 --out out");
  const auto status = [&](const std::string& text) {
    const int s = connected("127.0.0.1");
    EXPECT_EQ(send(s, text.data(), text.size(), MSG_NOSIGNAL), ssize_t(text.size()));
    char part[16] = "";
    const ssize_t n = recv(s, part, 12, MSG_WAITALL);
    close(s);
    return n == 12 ? std::stoi(part + 9) : 0;
  };
  const std::string host = "Host: localhost\r\n";
  for (const std::string first :
       {"GET", "GET /", "GET / ", "GET /status FTP/1.1", "GET  HTTP/1.1", "\x16\x03\x01"})
    EXPECT_EQ(status(first + "\r\n" + host + "\r\n"), 400) << first;
  EXPECT_EQ(status("GET / HTTP/1.1\r\n" + host + "Host: evil\r\n\r\n"), 403);
  EXPECT_EQ(status("GET http://evil/ HTTP/1.1\r\n" + host + "\r\n"), 404);
  EXPECT_EQ(status("GET /status?a=%zz&&=& HTTP/1.0\r\nhOST:\tlocalhost \r\n\r\n"), 200);
  EXPECT_EQ(status("GET /picture.png?a=b&view=c HTTP/1.1\r\n" + host + "\r\n"), 400);
  EXPECT_EQ(status("GET /" + std::string(20000, 'a')), 400) << "too long";
  EXPECT_EQ(status("POST / HTTP/1.1\r\n" + host + "Content-Length: 9\r\n\r\n123456789"), 405);
}

TEST_F(Live, TellsOfARunThatFails) {
  begin("0 --out out --set time.dt=0.0001");
  const Json s = status_when([](const Json& now) { return now["step"] > 5; });
  EXPECT_EQ(s["limit"], "fixed");
  std::filesystem::rename(dir_ / "out", dir_ / "gone");
  const Json last = status_when([](const Json& now) { return now["state"] == "failed"; });
  EXPECT_NE(std::string(last["message"]).find("out/"), std::string::npos) << last;
  EXPECT_EQ(end(), 2);
  EXPECT_EQ(content_of(dir_ / "live_err.txt"), std::string(last["message"]) + "\n");
}

TEST_F(Live, APortThatIsTakenEndsTheRunBeforeItBegins) {
  begin("0 --out out");
  const std::string port = std::to_string(port_);
  const Outcome taken = bedload("run stirred.toml --backend cpu --live " + port + " --out other");
  EXPECT_EQ(taken.code, 2);
  EXPECT_EQ(taken.out, "");
  EXPECT_TRUE(taken.err.starts_with("command line: --live: port " + port)) << taken.err;
  EXPECT_NE(taken.err.find("in use"), taken.err.npos) << taken.err;
  for (const std::string wrong : {"80", "65536", "-1", "1e4", "stirred.toml", "99999999999", "8020x"}) {
    const Outcome o = bedload("run stirred.toml --backend cpu --out other --live=" + wrong);
    EXPECT_EQ(o.code, 2) << wrong;
    EXPECT_TRUE(o.err.starts_with("command line: --live: " + wrong)) << o.err;
    EXPECT_NE(o.err.find("1024..65535"), o.err.npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  }
  EXPECT_FALSE(std::filesystem::exists(dir_ / "other"));
}

}  // namespace
}  // namespace bedload::test
