// SPDX-License-Identifier: BSD-3-Clause
// Figures as a table for people and as JSON for scripts.
#pragma once

#include "machine_info.h"
#include "memory_use.h"
#include "stage_timing.h"
#include "update_timing.h"

#include <ostream>
#include <string>
#include <vector>

namespace depth_object_tracker {

struct BenchmarkReport {
  MachineInfo machine;
  std::vector<MemoryUse> memory;
  std::vector<UpdateTiming> updates;
  std::vector<StageTiming> soft_stages, hard_stages;  ///< default outline, and the paper's

  std::int64_t heapAllocations() const;
};

void printMachine(const MachineInfo& machine, std::ostream& out);
void printMemory(const std::vector<MemoryUse>& memory, std::ostream& out);
void printUpdateHeader(std::ostream& out);
void printUpdate(const UpdateTiming& timing, std::ostream& out);
void printStages(const std::vector<StageTiming>& soft, const std::vector<StageTiming>& hard, std::ostream& out);

/// @throws std::runtime_error when the file cannot be written.
void writeJson(const BenchmarkReport& report, const std::string& file);

}  // namespace depth_object_tracker
