//! The layers over the floor, as the command line names them.

use underfoot_scene::scene::Show;

/// Reads names of layers, separated by commas, or one of `usual`, `all` and `none`.
///
/// # Errors
/// For a name without a layer: a sentence with all names.
pub(super) fn read_layers(text: &str) -> Result<Show, String> {
    let mut show = Show::WINDOW;
    match text {
        "usual" => return Ok(show),
        "all" => Show::LAYERS.iter().for_each(|(_, layer)| *layer(&mut show) = true),
        "none" => Show::LAYERS.iter().for_each(|(_, layer)| *layer(&mut show) = false),
        names => {
            show = read_layers("none")?;
            for wanted in names.split(',').map(str::trim) {
                let named = Show::LAYERS.iter().find(|(name, _)| option_name(name) == wanted);
                let (_, layer) = named.ok_or_else(|| unknown(wanted))?;
                *layer(&mut show) = true;
            }
        }
    }
    Ok(show)
}

/// The name of a layer in the menu, in the form of options.
fn option_name(name: &str) -> String {
    name.to_lowercase().replace(' ', "-")
}

fn unknown(wanted: &str) -> String {
    let names: Vec<String> = Show::LAYERS.iter().map(|(name, _)| option_name(name)).collect();
    format!("there is no layer `{wanted}`; use usual, all, none, or some of {}", names.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_go_by_the_names_of_the_menu() {
        assert_eq!(read_layers("usual"), Ok(Show::WINDOW));
        for (name, layer) in Show::LAYERS {
            let mut one = read_layers(&option_name(name)).unwrap();
            assert!(*layer(&mut one), "{name}");
            *layer(&mut one) = false;
            assert_eq!(Ok(one), read_layers("none"), "{name} alone");
        }
        let mut two = read_layers("contacts, tile-forces").unwrap();
        assert!(two.contacts && two.loads && !two.sensors && two.ruler);
        for (_, layer) in Show::LAYERS {
            *layer(&mut two) = true;
        }
        assert_eq!(read_layers("all"), Ok(two));
        let refused = read_layers("contacts,heat").unwrap_err();
        assert!(refused.contains("`heat`") && refused.contains("sensor-health"), "{refused}");
    }
}
