# What comes over the network: envelopes, each kind of published message, what nodes and the time-master
# tell each other, and the protocol itself under any order of events.
dmise_fuzz(fuzz_envelope SOURCES fuzz_envelope.cpp DEPENDS wire_examples wire)
foreach(kind object_roster object_states environment_state site_state frame_report detection_set truth_set)
  dmise_fuzz(fuzz_${kind} SOURCES fuzz_published.cpp DEPENDS wire_examples wire)
  target_compile_definitions(fuzz_${kind} PRIVATE DMISE_KIND=${kind})
endforeach()
dmise_fuzz(fuzz_node_message SOURCES fuzz_node_message.cpp DEPENDS conversation)
dmise_fuzz(fuzz_master_message SOURCES fuzz_master_message.cpp DEPENDS conversation)
dmise_fuzz(fuzz_resend_request SOURCES fuzz_resend_request.cpp DEPENDS wire_examples conversation)
dmise_fuzz(fuzz_coordinator SOURCES fuzz_coordinator.cpp DEPENDS coordinator)
