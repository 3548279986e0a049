"""The long tests of faults, `make test-faults`; what they measure is quoted in docs/reliability.md."""
