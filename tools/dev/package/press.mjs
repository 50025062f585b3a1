// Prints the events of the control `home` of a floor: node press.mjs ADDRESS; ends soon after a click.
import { connect } from "underfoot";

const floor = connect(process.argv[2]);
for (const name of ["pressed", "released", "cancelled", "clicked"]) {
  floor.on(name, "home", () => console.log("home", name));
}
// Later events would show here as well.
floor.on("clicked", "home", () => setTimeout(() => process.exit(), 500));
setTimeout(() => process.exit(1), 30_000).unref();
