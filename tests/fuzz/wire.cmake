# libFuzzer targets of the wire: build/fuzz/bin/fuzz_wire -max_total_time=60
if(DMISE_FUZZ)
  dmise_program(fuzz_wire SOURCES fuzz_wire.cpp DEPENDS wire_examples wire)
  target_link_options(fuzz_wire PRIVATE -fsanitize=fuzzer)
endif()
