"""Tests of engine.known."""
