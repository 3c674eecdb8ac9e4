"""What the tests run on: plans, the simulator, the real host, an MCU that speaks another version."""
