dmise_fuzz(fuzz_scenario SOURCES fuzz_scenario.cpp DEPENDS core_config)
