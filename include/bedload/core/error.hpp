#pragma once
// The four ways in which Bedload stops. Host code throws them; only main catches.

#include <stdexcept>
#include <string>
#include <utility>

namespace bedload {

/// A case, command line or input file that cannot be run. Exit code 2.
struct CaseError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The same of a case that was read already, by the path of a key ("fluid.fill.0.max"); `placed` adds where
/// the case gives it.
struct KeyError : CaseError {
  KeyError(std::string of, const std::string& what) : CaseError(what), key(std::move(of)) {}
  std::string key;
};

/// A file that cannot be read or written. Exit code 2.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// No such device, or too little of its memory. Exit code 2.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The computation broke down (NaN, density out of range, particle lost in a
/// closed box). Exit code 3. The message names particle, place and time.
struct SimulationFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace bedload
