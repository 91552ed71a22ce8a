//! navigation.
