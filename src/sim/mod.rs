//! A simulated floor: plates, sensors and feet that make the packets a real floor would.
