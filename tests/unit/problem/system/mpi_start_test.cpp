#include "problem/processes/mpi_start.h"

#include <gtest/gtest.h>

#include <string>

namespace springproof {
namespace {

struct MpiStart : testing::Test {
  MpiStart() { TearDown(); }
  void TearDown() override {
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "OMPI_MCA_ess_singleton_isolated",
                             "OMPI_MCA_orte_create_session_dirs", "OMPI_MCA_pml"})
      unsetenv(name);
  }
  static std::string value(const char* name) {
    const char* set = std::getenv(name);
    return set ? set : "not set";
  }
};

TEST_F(MpiStart, AloneStartsNoDaemonAndLooksForNoNetworkNorForAFolderThatOthersRemove) {
  start_mpi_without_network();
  EXPECT_EQ(value("OMPI_MCA_orte_create_session_dirs"), "0");
  EXPECT_EQ(value("OMPI_MCA_ess_singleton_isolated"), "1");
  EXPECT_EQ(value("OMPI_MCA_pml"), "ob1");
}

TEST_F(MpiStart, UnderMpirunNothingIsSet) {
  setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
  start_mpi_without_network();
  EXPECT_EQ(value("OMPI_MCA_ess_singleton_isolated"), "not set");
  EXPECT_EQ(value("OMPI_MCA_pml"), "not set");
}

TEST_F(MpiStart, WhatTheUserHasSetStays) {
  setenv("OMPI_MCA_pml", "ucx", 1);
  start_mpi_without_network();
  EXPECT_EQ(value("OMPI_MCA_pml"), "ucx");
}

}  // namespace
}  // namespace springproof
