//! What the parameters are called that the machine builder gives to the operator.

use bahn_parameters::operation::UserText;

/// Characters of the text of a user parameter of a TNC 151/155 [001:1323].
const USER_TEXT_MAX: usize = 16;

/// What a user parameter is called: by a line of the PLC dialogues, or by a PLC error message of at most 16 characters, else
/// `USER PAR. 1` [001:1315-1328].
pub(super) fn dialogue_of(text: UserText, dialogues: &[String], messages: &[String]) -> Option<String> {
    match text {
        UserText::Dialogue(line) => dialogues.get(usize::from(line)).cloned(),
        UserText::PlcError { number, place } => {
            let named = messages.get(usize::from(number)).filter(|text| !text.is_empty());
            Some(named.map_or_else(
                || format!("USER PAR. {place}"),
                |text| text.chars().take(USER_TEXT_MAX).collect(),
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use bahn_parameters::ParameterList;

    use super::*;

    /// USER PAR. 1 is PLC: ERROR 99, USER PAR. 16 is PLC: ERROR 84; without a text it is called so [001:1315-1332].
    #[test]
    fn user_parameters_of_a_tnc_155_have_texts_of_the_plc() {
        let mut list = ParameterList::reference(bahn_parameters::ControlModel::Tnc155);
        for assignment in ["217=0 P", "54=0.5 P"] {
            assert!(list.assign(assignment).is_ok());
        }
        let mut messages = vec![String::new(); 100];
        messages[99] = "ACCELERATION OF ALL AXES".to_owned();
        let texts: Vec<_> = list
            .user_parameters()
            .into_iter()
            .map(|own| (own.id.to_string(), dialogue_of(own.text, &[], &messages)))
            .collect();
        // Sixteen characters at most [001:1323].
        let named = |number: &str, text: &str| (number.to_owned(), Some(text.to_owned()));
        assert_eq!(
            texts,
            [named("MP54", "ACCELERATION OF "), named("MP217", "USER PAR. 2")]
        );
    }
}
