#pragma once
// Ctrl-C and SIGTERM end a run after the current step. A second Ctrl-C ends it at once.

namespace bedload {

/// The user stopped the program before there was anything to save.
struct Stopped {};

/// Installs the signal handlers.
void watch_signals();
bool stop_requested();

}  // namespace bedload
