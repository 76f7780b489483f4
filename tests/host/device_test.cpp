// The choice of the device.
#include <gtest/gtest.h>

#include <boost/compute/platform.hpp>
#include <cctype>
#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include "tests/host/support.hpp"

namespace flaunay::host {
namespace {

std::string changed_case(std::string text, int (*change)(int)) {
  for (char& c : text) c = static_cast<char>(change(static_cast<unsigned char>(c)));
  return text;
}

class SmallFindDevice : public ::testing::Test {
 protected:
  SmallFindDevice() : environment_("FLAUNAY_DEVICE", nullptr), devices_(all_devices()) {}
  /// For a name that must not be found.
  void expect_listing(const std::string& wanted, const std::string& shown) {
    const std::string message = message_of([&] { find_device(wanted); }, CL_SUCCESS);
    EXPECT_TRUE(contains(message, shown)) << message;
    for (std::size_t k = 0; k < devices_.size(); ++k) {
      EXPECT_TRUE(contains(message, "#" + std::to_string(k) + " " + devices_[k].name())) << message;
      EXPECT_TRUE(contains(message, devices_[k].platform().name())) << message;
    }
  }
  ScopedEnvironment environment_;
  std::vector<boost::compute::device> devices_;
};

TEST_F(SmallFindDevice, ByNumber) {
  ASSERT_FALSE(devices_.empty());
  for (std::size_t k = 0; k < devices_.size(); ++k) {
    EXPECT_EQ(find_device("#" + std::to_string(k)).id(), devices_[k].id());
  }
  for (const char* const wanted : {"#99", "#", "#x", "#0x", "#-1", "#18446744073709551616"}) {
    expect_listing(wanted, wanted);
  }
  expect_listing("#" + std::to_string(devices_.size()), "#" + std::to_string(devices_.size()));
}

TEST_F(SmallFindDevice, ByPartOfANameInAnyCase) {
  const auto& device = devices_.front();
  for (const std::string& name : {device.name(), device.platform().name()}) {
    const std::string part = name.substr(1);
    EXPECT_EQ(find_device(name).id(), device.id());
    EXPECT_EQ(find_device(changed_case(part, std::toupper)).id(), device.id());
    EXPECT_EQ(find_device(changed_case(part, std::tolower)).id(), device.id());
  }
}

TEST_F(SmallFindDevice, AnUnknownNameListsWhatThereIs) { expect_listing("no such device", "no such device"); }

TEST_F(SmallFindDevice, WithoutANameOneWithDoubles) {
  EXPECT_TRUE(has_fp64(find_device("")));
  const ScopedEnvironment empty("FLAUNAY_DEVICE", "");
  EXPECT_TRUE(has_fp64(find_device("")));
}

TEST_F(SmallFindDevice, ByTheEnvironment) {
  const std::string last = "#" + std::to_string(devices_.size() - 1);
  const ScopedEnvironment environment("FLAUNAY_DEVICE", last.c_str());
  EXPECT_EQ(find_device("").id(), devices_.back().id());
  EXPECT_EQ(find_device("#0").id(), devices_.front().id());
  const ScopedEnvironment wrong("FLAUNAY_DEVICE", "Nonesuch 9000");
  expect_listing("", "Nonesuch 9000");
  expect_listing("", "FLAUNAY_DEVICE");
  EXPECT_EQ(find_device("#0").id(), devices_.front().id());  // a name given goes first
}

TEST(SmallMayHaveGpu, IsToldByDeviceFilesOrTheEnvironment) {
  const ScopedEnvironment vendors("OCL_ICD_VENDORS", nullptr), files("OCL_ICD_FILENAMES", nullptr);
  const TemporaryFolder folder;
  EXPECT_FALSE(may_have_gpu(folder.path()));
  EXPECT_FALSE(may_have_gpu(folder.path() + "/none"));
  {
    const ScopedEnvironment chosen("OCL_ICD_VENDORS", "libpocl.so");
    EXPECT_TRUE(may_have_gpu(folder.path()));
  }
  std::ofstream(folder.path() + "/null");
  EXPECT_FALSE(may_have_gpu(folder.path()));
  std::ofstream(folder.path() + "/nvidiactl");
  EXPECT_TRUE(may_have_gpu(folder.path()));
}

}  // namespace
}  // namespace flaunay::host
