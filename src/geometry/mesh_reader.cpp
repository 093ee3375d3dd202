// SPDX-License-Identifier: BSD-3-Clause
// mesh_reader EXTENSION SCALE MEMORY_MIB CPU_S <FILE >REPLY: parses a mesh file for IsolatedMeshLoader. Whatever the
// file makes of this process, it can open, connect to, start and write nothing.
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "mesh_file_check.h"
#include "mesh_parser.h"
#include "mesh_reply.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <string>

namespace dot = depth_object_tracker;

namespace {

void limit(int resource, rlim_t value, rlim_t grace = 0) {
  const rlimit both{value, value + grace};
  if (::setrlimit(static_cast<__rlimit_resource>(resource), &both) != 0) std::_Exit(3);
}

/// Those of the process that started this one, which may have opened them without O_CLOEXEC.
void closeInheritedFiles() {
#ifdef SYS_close_range
  if (::syscall(SYS_close_range, 3u, ~0u, 0u) == 0) return;
#endif
  const long num_files = ::sysconf(_SC_OPEN_MAX);
  for (int file = 3; file < num_files; ++file) ::close(file);
}

void confine(rlim_t memory_mib, rlim_t cpu_s) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  closeInheritedFiles();
  limit(RLIMIT_CPU, cpu_s, 2);  // first the signal that tells why
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_NPROC, 0);
#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)  // their shadows take terabytes, their reports files
  limit(RLIMIT_AS, memory_mib << 20);
  limit(RLIMIT_NOFILE, 3);
#else
  static_cast<void>(memory_mib);
#endif
}

std::string readInput() {
  std::string content;
  char buffer[1 << 16];
  while (true) {
    const ssize_t count = ::read(STDIN_FILENO, buffer, sizeof(buffer));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw dot::MeshError("the file cannot be read");
    if (count == 0) return content;
    content.append(buffer, static_cast<std::size_t>(count));
    if (content.size() > dot::kMaxMeshFileBytes) throw dot::MeshError("the file grows while it is read");
  }
}

bool writeOutput(const std::string& reply) {
  std::size_t done = 0;
  while (done < reply.size()) {
    const ssize_t count = ::write(STDOUT_FILENO, reply.data() + done, reply.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

std::string replyFor(const std::string& extension, double scale) {
  try {
    return dot::encodeMeshReply(dot::parseMesh(readInput(), extension, scale));
  } catch (const std::bad_alloc&) {
    return dot::encodeErrorReply("there is not enough memory to read it; the file is too large or damaged");
  } catch (const std::exception& error) {
    return dot::encodeErrorReply(error.what());
  }
}

}  // namespace

int main(int num_arguments, char** arguments) {
  if (num_arguments != 5) return 2;
  confine(std::strtoul(arguments[3], nullptr, 10), std::strtoul(arguments[4], nullptr, 10));
  return writeOutput(replyFor(arguments[1], std::strtod(arguments[2], nullptr))) ? 0 : 1;
}
