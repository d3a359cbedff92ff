#pragma once
// A live view of a run for browsers on this machine.

#include <memory>
#include <string>

#include "view.hpp"

namespace bedload {

/// Serves a view on 127.0.0.1 and no other address, until it is destroyed: then pages that look on are given
/// a moment to take the last state. Answers GET from the machine's own names alone, so that no site that a
/// browser shows may read it by another name, and serves no file.
class LiveServer {
 public:
  static constexpr int kDefaultPort = 8020, kLeastPort = 1024, kMostPort = 65535;

  /// port: 0 for any that is free. `name`: of the case. Throws CaseError where the port is taken.
  LiveServer(int port, std::string name);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  LiveView& view();
  /// "http://127.0.0.1:8020"
  std::string address() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bedload
