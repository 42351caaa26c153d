// Files that are not, or no longer, what save_forest wrote: every one is answered with an Error that names
// the file, never with a crash, and a save that fails leaves nothing behind.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "sim/base/error.h"
#include "sim/grid/forest_file.h"
#include "tests/sim/grid/sample_forests.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

fs::path file_with(const std::string& bytes) {
  const fs::path path = test::scratch_dir() / "given.vdb";
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// Loads and expects an Error about `path`; gives its kind and message.
std::pair<ErrorKind, std::string> refusal(const fs::path& path) {
  try {
    load_forest(path);
  } catch (const Error& error) {
    EXPECT_NE(error.where().find(path.string()), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty()) << error.what();
    return {error.kind(), error.what()};
  }
  ADD_FAILURE() << "was loaded";
  return {};
}

std::string whole_file() {
  const fs::path path = test::scratch_dir() / "whole.vdb";
  save_forest(test::varied_forest(), path);
  return bytes_of(path);
}

// Every length of the first and last stretch, and one in 97 between; the same file is cut shorter and
// shorter.
TEST(DamagedForestFile, TruncatedAnywhere) {
  const std::string whole = whole_file();
  const auto path = file_with(whole);
  for (std::size_t n = whole.size() - 1; n > 0; --n) {
    if (n > 1000 && n + 200 < whole.size() && n % 97 != 0) continue;
    fs::resize_file(path, n);
    EXPECT_EQ(refusal(path).first, ErrorKind::kInvalidInput) << "at " << n << " of " << whole.size();
    EXPECT_THROW(summarize_forest_file(path), Error) << n;
  }
  fs::resize_file(path, 0);
  EXPECT_NE(refusal(path).second.find("empty"), std::string::npos);
}

TEST(DamagedForestFile, OneFlippedBitIsSeen) {
  const std::string whole = whole_file();
  for (std::size_t at = 0; at < whole.size(); at += whole.size() / 61) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    EXPECT_EQ(refusal(file_with(damaged)).first, ErrorKind::kInvalidInput) << at;
  }
}

TEST(DamagedForestFile, BytesAddedAtTheEnd) {
  EXPECT_NE(refusal(file_with(whole_file() + "x")).second.find("changed by another program"),
            std::string::npos);
}

TEST(DamagedForestFile, MissingFileIsNotFound) {
  EXPECT_EQ(refusal(test::scratch_dir() / "absent.vdb").first, ErrorKind::kNotFound);
}

TEST(DamagedForestFile, FolderIsNoFile) {
  EXPECT_EQ(refusal(test::scratch_dir()).first, ErrorKind::kInvalidInput);
}

TEST(DamagedForestFile, TextIsNoVdb) {
  EXPECT_NE(refusal(file_with("id_tree,species,x,y,dbh_cm\n1,beech,0,0,20\n")).second.find("no whole .vdb"),
            std::string::npos);
}

// A complete .vdb file of no grids and no metadata as any program could write it (format 224, OpenVDB 10.0).
TEST(DamagedForestFile, OtherProgramsVdb) {
  std::string bytes(" BDV\0\0\0\0", 8);
  const auto add_number = [&](std::uint32_t number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  for (const std::uint32_t number : {224U, 10U, 0U}) add_number(number);
  bytes += '\1';                                    // has grid offsets
  bytes += "01234567-89ab-cdef-0123-456789abcdef";  // UUID
  add_number(0);                                    // metadata entries
  add_number(0);                                    // grids
  EXPECT_NE(refusal(file_with(bytes)).second.find("another program"), std::string::npos);
}

// ---- saving

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(FailedSave, MissingFolder) {
  const fs::path path = test::scratch_dir() / "no" / "such" / "folder.vdb";
  try {
    save_forest(test::leafless_forest(), path);
    FAIL() << "was saved";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInputOutput);
    EXPECT_EQ(error.where(), path.string());
  }
}

TEST(FailedSave, TargetIsAFolder) {
  const fs::path folder = test::scratch_dir() / "folder_target";
  fs::create_directories(folder / "full.vdb" / "inner");
  EXPECT_THROW(save_forest(test::leafless_forest(), folder / "full.vdb"), Error);
  EXPECT_EQ(files_in(folder), 1U);
}

// A full disk, played by a limit on the size of files: the write fails half-way, the old file stays whole.
TEST(FailedSave, DiskFullLeavesTheOldFileAndNoOther) {
  const fs::path folder = test::scratch_dir() / "disk_full";
  fs::create_directories(folder);
  save_forest(test::leafless_forest(), folder / "forest.vdb");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  for (const rlim_t bytes : {rlim_t{100}, rlim_t{20'000}, rlim_t{100'000}}) {
    rlimit limit = before;
    limit.rlim_cur = bytes;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    EXPECT_THROW(save_forest(test::large_forest(20'000), folder / "forest.vdb"), Error) << bytes;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_EQ(files_in(folder), 1U);
  }
  EXPECT_EQ(load_forest(folder / "forest.vdb").name, "winter");
}

TEST(FailedSave, InvalidForestIsRefused) {
  Forest forest = test::leafless_forest();
  forest.instances[0].prototype.value = 99;
  EXPECT_THROW(save_forest(forest, test::scratch_dir() / "invalid.vdb"), Error);
  EXPECT_FALSE(fs::exists(test::scratch_dir() / "invalid.vdb"));
}

TEST(FailedSave, NameThatIsNoUtf8IsRefused) {
  Forest forest = test::leafless_forest();
  forest.name = "\xff\xfe";
  EXPECT_THROW(save_forest(forest, test::scratch_dir() / "latin1.vdb"), Error);
  EXPECT_FALSE(fs::exists(test::scratch_dir() / "latin1.vdb"));
}

}  // namespace
}  // namespace sunfleck
