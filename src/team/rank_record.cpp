#include "bedload/parallel/rank_record.hpp"

namespace bedload {

RankRecord& rank_record() {
  static thread_local RankRecord record;
  return record;
}

}  // namespace bedload
