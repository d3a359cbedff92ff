#include "server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <pthread.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <csignal>
#include <thread>

#include "bedload/core/cores.hpp"
#include "bedload/core/error.hpp"
#include "live_page.hpp"

namespace bedload {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kLookedLately = 3s;  // pages ask for the status every second
constexpr auto kToBeTold = 1000ms, kSilence = 500ms, kLongestEnd = 5000ms;
constexpr const char* kHost = "127.0.0.1";
// With a parameter, since the library compresses what has none, which takes the run's time.
constexpr const char* kJson = "application/json; charset=utf-8";
constexpr const char* kPolicy =
    "default-src 'none'; connect-src 'self'; img-src 'self' blob:; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Whether a Host header names this machine to itself, at any port: a tunnel may have another one.
bool names_this_machine(const std::string& host) {
  for (const std::string name : {"localhost", kHost}) {
    if (!host.starts_with(name)) continue;
    const std::string rest = host.substr(name.size());
    return rest.empty() ||
           (rest.size() > 1 && rest[0] == ':' &&
            std::all_of(rest.begin() + 1, rest.end(), [](unsigned char c) { return std::isdigit(c); }));
  }
  return false;
}

/// The threads made while it lives take no signal: those are the run's.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

}  // namespace

struct LiveServer::Impl {
  explicit Impl(std::string name) : view(std::move(name)) {}

  void answer(const httplib::Request& request, httplib::Response& response) {
    if (!names_this_machine(request.get_header_value("Host")))
      return refuse(response, 403, "Forbidden: another host");
    if (request.method != "GET") {
      response.set_header("Allow", "GET");
      return refuse(response, 405, "Only GET");
    }
    const std::string& path = request.path;
    if (!closing || path != "/status") asked = Clock::now();
    const std::string of_table = "/tables/";
    response.status = 200;
    if (path == "/") {
      response.set_header("Content-Security-Policy", kPolicy);
      response.set_content(kLivePage, "text/html; charset=utf-8");
    } else if (path == "/status") {
      response.set_content(view.status(), kJson);
    } else if (path == "/tables") {
      response.set_content(view.tables(), kJson);
    } else if (path.starts_with(of_table)) {
      if (auto table = view.table(path.substr(of_table.size()))) return response.set_content(*table, kJson);
      refuse(response, 404, "There is no such table");
    } else if (path == "/picture.png") {
      const auto side = live_side(request.has_param("view") ? request.get_param_value("view") : "front");
      if (!side) return refuse(response, 400, "view: front, above or perspective");
      if (auto picture = view.picture(*side)) return response.set_content(*picture, "image/png");
      refuse(response, 404, "There is no picture yet");
    } else {
      refuse(response, 404, "There is nothing here");
    }
  }

  static void refuse(httplib::Response& response, int status, const char* why) {
    response.status = status;
    response.set_content(std::string(why) + "\n", "text/plain; charset=utf-8");
  }

  void open(int wanted) {
    server.set_address_family(AF_INET);
    server.set_socket_options([](int socket) {  // the library would share the port with other runs
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.new_task_queue = [] { return new httplib::ThreadPool(4); };
    server.set_keep_alive_max_count(1);  // else idle connections would hold the threads
    server.set_read_timeout(2s);
    server.set_write_timeout(2s);
    server.set_payload_max_length(1024);
    server.set_default_headers({{"Cache-Control", "no-store"},
                                {"X-Content-Type-Options", "nosniff"},
                                {"Cross-Origin-Resource-Policy", "same-origin"},
                                {"Referrer-Policy", "no-referrer"}});
    server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      answer(request, response);
      return httplib::Server::HandlerResponse::Handled;
    });
    port = wanted == 0 ? server.bind_to_any_port(kHost) : server.bind_to_port(kHost, wanted) ? wanted : -1;
    if (port < 0)
      throw CaseError(
          fmt::format("command line: --live: port {} of {} is taken; name another, or 0 for any that is free",
                      wanted, kHost));
    const SignalsBlocked blocked;
    thread = std::thread([this] {
      use_all_cores();
      server.listen_after_bind();
    });
    while (!server.is_running()) std::this_thread::sleep_for(1ms);  // stop() does nothing before
  }

  void close() {
    const auto from = Clock::now();
    const auto silent = [&] { return Clock::now() - std::max(asked.load(), from + kToBeTold) > kSilence; };
    closing = true;
    if (from - asked.load() < kLookedLately)
      while (!silent() && Clock::now() - from < kLongestEnd) std::this_thread::sleep_for(20ms);
    server.stop();
    thread.join();
  }

  LiveView view;
  httplib::Server server;
  int port = -1;
  std::atomic<Clock::time_point> asked{};
  std::atomic<bool> closing{false};
  std::thread thread;
};

LiveServer::LiveServer(int port, std::string name) : impl_(std::make_unique<Impl>(std::move(name))) {
  impl_->open(port);
}

LiveServer::~LiveServer() { impl_->close(); }

LiveView& LiveServer::view() { return impl_->view; }

std::string LiveServer::address() const { return fmt::format("http://{}:{}", kHost, impl_->port); }

}  // namespace bedload
