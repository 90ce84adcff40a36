//! Where names are set and used.

use lsp_types::{
    DocumentHighlight, DocumentHighlightKind, DocumentHighlightParams, GotoDefinitionParams,
    GotoDefinitionResponse, Location, Position, Range, ReferenceParams,
};

use super::{Reply, View};
use crate::language::{Role, Thing, mention_at, mentions_of};
use crate::uri::uri_of;

pub(super) fn definition(
    view: &View<'_>,
    params: GotoDefinitionParams,
) -> Reply<Option<GotoDefinitionResponse>> {
    let place = &params.text_document_position_params;
    let Some((opened, at)) = view.place(place) else {
        return Reply::Done(None);
    };
    let mentions = opened.analysis.mentions();
    let Some(mention) = mention_at(mentions, at) else {
        return Reply::Done(None);
    };
    if let Some(there) = opened.analysis.elsewhere(&mention.thing, view.world) {
        let place = |character| Position::new(there.line, character);
        let range = Range::new(place(there.characters.start), place(there.characters.end));
        let location = uri_of(&there.path).map(|uri| Location::new(uri, range));
        return Reply::Done(location.map(GotoDefinitionResponse::Scalar));
    }
    let sets = mentions_of(mentions, &mention.thing).filter(|other| other.role == Role::Sets);
    let uri = &place.text_document.uri;
    let locations: Vec<Location> = sets
        .map(|other| Location::new(uri.clone(), opened.text.range(&other.range)))
        .collect();
    Reply::Done((!locations.is_empty()).then_some(GotoDefinitionResponse::Array(locations)))
}

pub(super) fn references(view: &View<'_>, params: ReferenceParams) -> Reply<Option<Vec<Location>>> {
    let place = &params.text_document_position;
    let Some((opened, at)) = view.place(place) else {
        return Reply::Done(None);
    };
    let mentions = opened.analysis.mentions();
    let thing = mention_at(mentions, at).map(|mention| &mention.thing);
    let uri = &place.text_document.uri;
    Reply::Done(thing.map(|thing| {
        mentions_of(mentions, thing)
            .filter(|other| params.context.include_declaration || other.role == Role::Uses)
            .map(|other| Location::new(uri.clone(), opened.text.range(&other.range)))
            .collect()
    }))
}

pub(super) fn highlights(
    view: &View<'_>,
    params: DocumentHighlightParams,
) -> Reply<Option<Vec<DocumentHighlight>>> {
    let Some((opened, at)) = view.place(&params.text_document_position_params) else {
        return Reply::Done(None);
    };
    let mentions = opened.analysis.mentions();
    let thing: Option<&Thing> = mention_at(mentions, at).map(|mention| &mention.thing);
    Reply::Done(thing.map(|thing| {
        mentions_of(mentions, thing)
            .map(|other| DocumentHighlight {
                range: opened.text.range(&other.range),
                kind: Some(match other.role {
                    Role::Sets => DocumentHighlightKind::WRITE,
                    Role::Uses => DocumentHighlightKind::READ,
                }),
            })
            .collect()
    }))
}
