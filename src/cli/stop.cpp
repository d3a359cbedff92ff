#include "stop.hpp"

#include <csignal>

namespace bedload {
namespace {

volatile std::sig_atomic_t stop = 0;

/// Only a second Ctrl-C ends the program at once: batch systems may send SIGTERM twice.
void on_signal(int signal) {
  if (stop && signal == SIGINT) {
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
  }
  stop = 1;
}

}  // namespace

void watch_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit becomes a write error
}

bool stop_requested() { return stop != 0; }

}  // namespace bedload
