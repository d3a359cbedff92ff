#include "server.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <cctype>
#include <chrono>
#include <csignal>
#include <list>
#include <thread>
#include <vector>

#include "bedload/core/cores.hpp"
#include "bedload/core/error.hpp"
#include "live_page.hpp"

namespace bedload {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using http::status;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr auto kViewedLately = 3s;  // pages ask for the status every second
constexpr auto kLastFetch = 1000ms, kIdle = 1000ms, kLongestClose = 5000ms;  // after the end of the run
constexpr auto kRequestTimeout = 2s, kResponseTimeout = 10s;
constexpr std::size_t kMostConnections = 64, kLongestRequest = 16384;
constexpr const char *kHost = "127.0.0.1", *kStatus = "/status", *kPicture = "/picture.png",
                     *kTable = "/tables/";
constexpr const char* kJson = "application/json; charset=utf-8";
constexpr const char* kPolicy =
    "default-src 'none'; connect-src 'self'; img-src 'self' blob:; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Whether a Host header is localhost or 127.0.0.1 at any port: a tunnel may use another port.
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

/// Threads created while it lives block all signals, which the run handles.
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

Response response_of(status s, const char* type, std::string body) {
  Response r(s, 11);
  r.set(http::field::content_type, type);
  r.set(http::field::cache_control, "no-store");
  r.set("X-Content-Type-Options", "nosniff");
  r.set("Cross-Origin-Resource-Policy", "same-origin");
  r.set("Referrer-Policy", "no-referrer");
  r.keep_alive(false);
  r.body() = std::move(body);
  r.prepare_payload();
  return r;
}

Response refusal(status s, const char* why) {
  return response_of(s, "text/plain; charset=utf-8", std::string(why) + "\n");
}

struct Connection {
  explicit Connection(tcp::socket socket) : stream(std::move(socket)) {
    request.header_limit(kLongestRequest);
  }

  beast::tcp_stream stream;
  beast::flat_buffer buffer{kLongestRequest};
  http::request_parser<http::empty_body> request;
  Response response;
};

}  // namespace

/// One thread serves requests, another draws pictures, so that only requests for pictures wait for them.
struct LiveServer::Impl {
  explicit Impl(std::string name) : view(std::move(name)) {}

  Response answer(const Request& request) {
    if (request.count(http::field::host) != 1 || !names_this_machine(std::string(request[http::field::host])))
      return refusal(status::forbidden, "Forbidden: unknown host");
    if (request.method() != http::verb::get) {
      Response r = refusal(status::method_not_allowed, "GET only");
      r.set(http::field::allow, "GET");
      if (request.method() == http::verb::head) r.body().clear();
      return r;
    }
    const std::string target(request.target());
    const auto mark = std::min(target.find('?'), target.size());
    const std::string path = target.substr(0, mark);
    if (!closing || path != kStatus) asked = Clock::now();
    if (path == "/") {
      Response r = response_of(status::ok, "text/html; charset=utf-8", kLivePage);
      r.set("Content-Security-Policy", kPolicy);
      return r;
    }
    if (path == kStatus) return response_of(status::ok, kJson, view.status());
    if (path == "/tables") return response_of(status::ok, kJson, view.tables());
    if (path.starts_with(kTable)) {
      auto table = view.table(path.substr(std::string_view(kTable).size()));
      return table ? response_of(status::ok, kJson, std::move(*table))
                   : refusal(status::not_found, "No such table");
    }
    if (path == kPicture) return picture("&" + target.substr(std::min(mark + 1, target.size())));
    return refusal(status::not_found, "Not found");
  }

  /// query: parameters, each after a "&".
  Response picture(const std::string& query) {
    const std::string name = "&view=";
    const auto at = query.find(name), from = at + name.size();
    const auto side =
        live_side(at == query.npos ? "front" : query.substr(from, query.find('&', from) - from));
    if (!side) return refusal(status::bad_request, "view: front, above or perspective");
    auto png = view.picture(*side);
    return png ? response_of(status::ok, "image/png", std::move(*png))
               : refusal(status::not_found, "No picture yet");
  }

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      connections.remove_if([](const auto& c) { return c.expired(); });
      if (!connections.empty() && (error || connections.size() >= kMostConnections)) {
        if (const auto oldest = connections.front().lock()) oldest->stream.close();
        connections.pop_front();
      }
      if (error) {  // too many open files
        pause.expires_after(50ms);
        return pause.async_wait([this](beast::error_code) { accept(); });
      }
      const auto c = std::make_shared<Connection>(std::move(socket));
      connections.push_back(c);
      read(c);
      accept();
    });
  }

  void read(std::shared_ptr<Connection> c) {
    c->stream.expires_after(kRequestTimeout);
    const auto then = [this, c](beast::error_code error, std::size_t) {
      const auto& of_http = make_error_code(http::error::bad_method).category();
      if (error && error.category() != of_http) return;
      const bool draws = !error && c->request.get().target().starts_with(kPicture);
      ++answering;
      asio::post(draws ? drawing : serving, [this, c, error]() mutable {
        try {
          c->response = error ? refusal(status::bad_request, "Bad request") : answer(c->request.get());
        } catch (const std::exception&) {
          c->response = refusal(status::internal_server_error, "Internal error");
        }
        asio::post(serving, [this, c = std::move(c)] { write(c); });
      });
    };
    http::async_read_header(c->stream, c->buffer, c->request, then);
  }

  void write(std::shared_ptr<Connection> c) {
    c->stream.expires_after(kResponseTimeout);
    http::async_write(c->stream, c->response, [this, c](beast::error_code error, std::size_t) {
      // time for the next request begins when this answer, perhaps slow to draw, has been sent
      if (c->response.result() == status::ok && !c->request.get().target().starts_with(kStatus))
        asked = Clock::now();
      --answering;
      // The client closes first: closing with unread data may lose the response.
      if (!error) c->stream.socket().shutdown(tcp::socket::shutdown_send, error);
      c->buffer.clear();
      if (!error) asio::async_read(c->stream, c->buffer, [c](beast::error_code, std::size_t) {});
    });
  }

  void open(int port) {
    try {
      acceptor = tcp::acceptor(serving, {asio::ip::make_address(kHost), std::uint16_t(port)});
    } catch (const boost::system::system_error& error) {
      if (error.code() == asio::error::address_in_use)
        throw CaseError(fmt::format(
            "command line: --live: port {} of {} is in use; choose another, or 0 for any free one", port,
            kHost));
      throw CaseError(fmt::format("command line: --live: cannot listen on port {} of {}: {}", port, kHost,
                                  error.code().message()));
    }
    accept();
    const SignalsBlocked blocked;
    for (asio::io_context* context : {&serving, &drawing})
      threads.emplace_back([context] {
        use_all_cores();
        const auto work = asio::make_work_guard(*context);
        context->run();
      });
  }

  /// Waits until viewers have seen the end and fetched the last pictures and tables.
  void close() {
    const auto from = Clock::now();
    const auto idle = [&] {
      return view.end_seen() && answering == 0 &&
             Clock::now() - std::max(asked.load(), from + kLastFetch) > kIdle;
    };
    closing = true;
    if (from - asked.load() < kViewedLately)
      while (!idle() && Clock::now() - from < kLongestClose) std::this_thread::sleep_for(20ms);
    serving.stop();
    drawing.stop();
    for (std::thread& thread : threads) thread.join();
  }

  LiveView view;
  std::atomic<Clock::time_point> asked{};
  std::atomic<bool> closing{false};
  std::atomic<int> answering{0};  ///< requests read and not yet answered
  asio::io_context serving,
      drawing;  ///< handlers of `drawing` use sockets of `serving`, which is destroyed last
  tcp::acceptor acceptor{serving};
  asio::steady_timer pause{serving};
  std::list<std::weak_ptr<Connection>> connections;  ///< oldest first
  std::vector<std::thread> threads;
};

LiveServer::LiveServer(int port, std::string name) : impl_(std::make_unique<Impl>(std::move(name))) {
  impl_->open(port);
}

LiveServer::~LiveServer() { impl_->close(); }

LiveView& LiveServer::view() { return impl_->view; }

std::string LiveServer::address() const {
  return fmt::format("http://{}:{}", kHost, impl_->acceptor.local_endpoint().port());
}

}  // namespace bedload
