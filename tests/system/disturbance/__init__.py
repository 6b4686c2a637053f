"""Networks of real processes that are killed, stopped, slowed, cut off and started again."""
